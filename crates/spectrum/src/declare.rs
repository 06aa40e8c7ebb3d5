//! The spectra that a scene can give, declared.
//!
//! The same kinds serve emission, reflectance, coefficients and the mean cosine of scattering, which
//! allow different numbers: so the tables check that numbers are finite, and whoever uses a spectrum
//! checks the rest.

use indigo_decl::{Alternatives, Block, Field, Kind, Presence, Range};

/// Unit of the value of a spectrum; only an emitter has the unit, elsewhere the number stands for itself.
const VALUE: &str = "W m^-3 sr^-1, or as its use says";

/// The same value at every wavelength.
pub static UNIFORM: Block = Block::new(
    "uniform",
    "The same value at every wavelength.",
    &[Field::new(
        "value",
        Kind::Real,
        Presence::Required,
        "The value: spectral radiance for an emitter, a plain number for a reflectance, per metre for \
         absorption and scattering. At least 0 but for the mean cosine of a phase function.",
    )
    .unit(VALUE)],
)
.with_example("<uniform><value>0.8</value></uniform>");

/// Planck's law.
pub static BLACKBODY: Block = Block::new(
    "blackbody",
    "The light of a black body, by Planck's law.",
    &[
        Field::new("temperature", Kind::Real, Presence::Required, "Temperature of the body.")
            .unit("K")
            .range(Range::Above(0.0)),
        Field::new(
            "gain",
            Kind::Real,
            Presence::Required,
            "Factor on Planck's spectral radiance. 1 is the radiance of a real black body, which is \
             far brighter than most lamps look.",
        )
        .range(Range::Above(0.0)),
    ],
)
.with_example("<blackbody><temperature>3500</temperature><gain>1.0</gain></blackbody>");

/// A box on a base.
pub static PEAK: Block = Block::new(
    "peak",
    "One value inside a band of wavelengths, another outside.",
    &[
        Field::new("peak_min", Kind::Real, Presence::Required, "Wavelength at which the band begins.")
            .unit("nm")
            .range(Range::AtLeast(0.0)),
        Field::new("peak_width", Kind::Real, Presence::Required, "Width of the band.")
            .unit("nm")
            .range(Range::Above(0.0)),
        Field::new("base_value", Kind::Real, Presence::Required, "Value outside the band.").unit(VALUE),
        Field::new("peak_value", Kind::Real, Presence::Required, "Value inside the band.").unit(VALUE),
    ],
)
.with_example(
    "<peak>
    <peak_min>300</peak_min>
    <peak_width>550</peak_width>
    <base_value>0</base_value>
    <peak_value>200</peak_value>
</peak>",
);

/// Factor on a colour.
const GAIN: Field = Field::new(
    "gain",
    Kind::Real,
    Presence::Default("1"),
    "Factor on the colour, after `gamma`, as later versions write it.",
)
.range(Range::AtLeast(0.0));

/// Tristimulus values.
pub static XYZ: Block = Block::new(
    "xyz",
    "A smooth spectrum of given tristimulus values of the CIE 1931 observer, as later versions write it: that of the \
     linear Rec. 709 colour with these values, where white (1, 1, 1) has the Y of 1. Colours that Rec. 709 does not \
     hold are brought to its border.",
    &[Field::new("xyz", Kind::Vec3, Presence::Required, "X, Y and Z.").unit(VALUE), GAIN],
)
.with_example("<xyz><xyz>0.95 1 1.09</xyz><gain>1</gain></xyz>");

/// A colour.
pub static RGB: Block = Block::new(
    "rgb",
    "A smooth spectrum of a given colour in linear Rec. 709 / D65, after `gamma` is undone. As a \
     reflectance it returns the colour under D65 and stays within [0, 1]; as an emission it has the \
     shape of D65, so that white looks white under the white balance D65; as a coefficient it is \
     linear in the three numbers and may be of any size.",
    &[
        Field::new("rgb", Kind::Vec3, Presence::Required, "Red, green and blue.").unit(VALUE),
        Field::new(
            "gamma",
            Kind::Real,
            Presence::Default("1"),
            "Each component is raised to this power first. 2.2 suits colours picked on a screen, 1 \
             suits coefficients.",
        )
        .range(Range::Above(0.0)),
        GAIN,
    ],
)
.with_example("<rgb><rgb>0.8 0.3 0.6</rgb><gamma>2.2</gamma></rgb>");

/// A table.
pub static REGULAR_TABULATED: Block = Block::new(
    "regular_tabulated",
    "Values at equally spaced wavelengths, with straight lines between them. Note that the wavelengths \
     are in metres.",
    &[
        Field::new("start_wavelength", Kind::Real, Presence::Required, "Wavelength of the first value.")
            .unit("m")
            .range(Range::AtLeast(0.0)),
        Field::new(
            "end_wavelength",
            Kind::Real,
            Presence::Required,
            "Wavelength of the last value; greater than that of the first.",
        )
        .unit("m")
        .range(Range::AtLeast(0.0)),
        Field::new("num_values", Kind::Int, Presence::Required, "How many values there are.")
            .range(Range::AtLeast(2.0)),
        Field::new(
            "values",
            Kind::Reals,
            Presence::Required,
            "The values, separated by blanks. Measured tables hold small negative values: they count \
             as zero where a negative value has no meaning.",
        )
        .unit(VALUE),
    ],
)
.with_example(
    "<regular_tabulated>
    <start_wavelength>4e-7</start_wavelength>
    <end_wavelength>7e-7</end_wavelength>
    <num_values>4</num_values>
    <values>0.1 0.5 0.9 0.2</values>
</regular_tabulated>",
);

/// The kinds of spectrum.
pub static SPECTRUM: Alternatives =
    Alternatives::new("spectrum", &[&UNIFORM, &BLACKBODY, &PEAK, &RGB, &XYZ, &REGULAR_TABULATED]);
