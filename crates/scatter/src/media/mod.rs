//! Media: what fills the inside of objects. One file each, and one line each in the list below.

pub mod basic;
pub mod dermis;
pub mod epidermis;

use indigo_decl::{Alternatives, Block, Field, Kind, Later, Presence, Range};

/// The kinds of medium.
pub static KINDS: &[&Block] = &[&basic::BLOCK, &epidermis::BLOCK, &dermis::BLOCK];

/// The declaration of `medium`.
pub static MEDIUM: Block = Block::new(
    "medium",
    "Defines a medium: a name, a precedence and one kind. Where it stands in the scene does not matter. \
     The children of `basic` may also stand directly in `medium`.",
    &[
        Field::new("name", Kind::Name, Presence::Required, "Name by which materials refer to it."),
        Field::new(
            "precedence",
            Kind::Int,
            Presence::Default("10"),
            "Where several media overlap, the one with the highest precedence is there and displaces the \
             others. Air, which fills the scene by itself, has 1.",
        )
        .range(Range::Above(1.0)),
    ],
)
.with_alternatives(Alternatives {
    implied: Some(&basic::BLOCK),
    later: &[Later::new("atmosphere", "3.0"), Later::new("fast_sss", "3.0")],
    ..Alternatives::new("kind of medium", KINDS)
})
.with_later(&[
    Later::new("uid", "3.0"),
    Later::new("metadata", "3.0"),
    Later::new("step_size", "3.0"),
    Later::new("max_extinction_coeff", "3.0"),
])
.with_example(
    "<medium>
    <name>milk</name>
    <precedence>8</precedence>
    <basic>
        <ior>1.33</ior>
        <cauchy_b_coeff>0</cauchy_b_coeff>
        <absorption_coefficient_spectrum>
            <rgb><rgb>11.5 5.75 2.875</rgb><gamma>1</gamma></rgb>
        </absorption_coefficient_spectrum>
        <subsurface_scattering>
            <scattering_coefficient_spectrum>
                <uniform><value>15000</value></uniform>
            </scattering_coefficient_spectrum>
            <phase_function>
                <henyey_greenstein>
                    <g_spectrum><uniform><value>0.9</value></uniform></g_spectrum>
                </henyey_greenstein>
            </phase_function>
        </subsurface_scattering>
    </basic>
</medium>",
);
