//! The camera, declared.

use indigo_decl::{Alternatives, Block, Field, Group, Kind, Later, Presence, Range};

/// The declaration of `camera`.
pub static CAMERA: Block = Block::new(
    "camera",
    "The camera: a thin lens before a flat sensor. The horizontal angle of view is \
     2·atan(sensor_width / (2·lens_sensor_dist)), whatever the focus. A scene must have a camera.",
    &[
        Field::new(
            "camera_type",
            Kind::Choice(&["thin-lens-perspective", "orthographic", "spherical"]),
            Presence::Default("thin-lens-perspective"),
            "What kind of camera it is. `orthographic` has parallel rays: the picture shows as many metres as \
             `sensor_width` says, which is that of a building rather than of a camera. `spherical` sees all directions from \
             `pos`, in columns round `up` and rows from the zenith to the nadir; its picture should be twice as wide as \
             high. Neither has a lens: all is in focus, without vignetting and diffraction. The exposure of the tone \
             mappings `linear` and `camera` is computed as if there were one.",
        ),
        Field::new(
            "pos",
            Kind::Vec3,
            Presence::Optional,
            "The centre of the lens. Needed unless there is a `keyframe`.",
        )
        .unit("m"),
        KEYFRAME,
        Field::new(
            "up",
            Kind::Vec3,
            Presence::Required,
            "Which way is up in the picture, of any length; only its part across `forwards` counts.",
        ),
        Field::new(
            "forwards",
            Kind::Vec3,
            Presence::Required,
            "Where the camera looks, of any length.",
        ),
        Field::new(
            "aperture_radius",
            Kind::Real,
            Presence::Required,
            "Radius of the aperture: the larger, the shallower the depth of field. With an aperture shape, half \
             the side of the square in which it is drawn.",
        )
        .unit("m")
        .range(Range::Above(0.0)),
        Field::new(
            "focus_distance",
            Kind::Real,
            Presence::Optional,
            "Distance of the plane in focus, along `forwards`. Needed unless `autofocus` is set, which takes its \
             place.",
        )
        .unit("m")
        .range(Range::Above(0.0)),
        Field::new(
            "aspect_ratio",
            Kind::Real,
            Presence::Required,
            "Width of the sensor over its height; should be that of the picture.",
        )
        .range(Range::Within(1e-3, 1e3)),
        Field::new("sensor_width", Kind::Real, Presence::Required, "Width of the sensor, such as 0.036.")
            .unit("m")
            .range(Range::Above(0.0)),
        Field::new(
            "lens_sensor_dist",
            Kind::Real,
            Presence::Required,
            "Distance from the lens to the sensor, such as 0.02. Zooms.",
        )
        .unit("m")
        .range(Range::Above(0.0)),
        Field::new(
            "lens_shift_right_distance",
            Kind::Real,
            Presence::Default("0"),
            "How far the lens is shifted to the right of the middle of the sensor: the picture shows what lies further to \
             the right, and parallel lines stay parallel. The lens stays at `pos`: it is the sensor that moves. Without a \
             lens, an `orthographic` sensor itself is moved as far.",
        )
        .unit("m"),
        Field::new(
            "lens_shift_up_distance",
            Kind::Real,
            Presence::Default("0"),
            "How far the lens is shifted up, likewise: what architecture is photographed with, as it keeps walls upright.",
        )
        .unit("m"),
        Field::new(
            "white_balance",
            Kind::Text,
            Presence::Default("D65"),
            "Which light looks white: A, B, C, D50, D55, D65, D75, E, F1 to F12, or two numbers, the \
             chromaticity x y. Names stand for the whites of their spectra in steps of 1 nm, to 1e-4; for F11 CIE 015 \
             prints one of steps of 5 nm, which differs by 2e-4. The white of F10 is the one published, which is 1e-3 \
             from its spectrum's.",
        ),
        Field::new(
            "white_point",
            Kind::Block(&WHITE_POINT),
            Presence::Optional,
            "The light that looks white, by numbers, as later versions write it. Where `white_balance` is given too, \
             that counts, with a warning.",
        ),
        Field::new(
            "exposure_duration",
            Kind::Real,
            Presence::Default("0.01"),
            "How long the shutter is open. Used by the tone mapping `linear` and `camera`: the exposure of the sensor is \
             luminance times the open area of the aperture over the square of `lens_sensor_dist`, times this.",
        )
        .unit("s")
        .range(Range::Above(0.0)),
        Field::new(
            "autofocus",
            Kind::Flag,
            Presence::Optional,
            "Focuses on what the camera sees in the middle of the picture; on infinity if that is nothing.",
        ),
        Field::new(
            "vignetting",
            Kind::Bool,
            Presence::Default("true"),
            "Whether the picture darkens towards its corners, by the cos⁴ law.",
        ),
        Field::new(
            "bloom",
            Kind::Block(&BLOOM),
            Presence::Optional,
            "A glow round bright spots.",
        )
        .deprecated("use aperture_diffraction, which computes the real effect"),
        Field::new(
            "obstacle_map",
            Kind::Path,
            Presence::Optional,
            "An image of dust and scratches on the lens, for the diffraction by the aperture: white where nothing stands, black \
             where no light passes. Has an effect only with `aperture_diffraction`, and none (a warning) where it is the same \
             all over; one that covers all of the aperture is an error. The path may also stand in a `path` inside.",
        ),
        Field::new(
            "aperture_shape",
            Kind::Block(&APERTURE_SHAPE),
            Presence::Optional,
            "The shape of the aperture: a circle where it is missing. Its open area sets the exposure (see \
             `exposure_duration`).",
        ),
    ],
)
.with_needs(&[Group::any(&["focus_distance", "autofocus"]), Group::any(&["pos", "keyframe"])])
.with_later(&[
    Later::new("name", "3.0"),
    Later::new("section_plane", "3.0"),
    Later::new("uid", "3.0"),
])
.with_ignored(&["polarising_filter", "polarising_angle", "glare_weight", "glare_radius", "glare_num_blades"])
.with_example(
    "<camera>
    <pos>0 -2 1</pos>
    <up>0 0 1</up>
    <forwards>0 1 0</forwards>
    <aperture_radius>0.001</aperture_radius>
    <focus_distance>3.0</focus_distance>
    <aspect_ratio>1.33</aspect_ratio>
    <sensor_width>0.036</sensor_width>
    <lens_sensor_dist>0.02</lens_sensor_dist>
    <white_balance>E</white_balance>
    <exposure_duration>0.01</exposure_duration>
    <autofocus/>
</camera>",
);

/// A place in time.
pub const KEYFRAME: Field = Field::new(
    "keyframe",
    Kind::Block(&KEYFRAME_BLOCK),
    Presence::Repeated,
    "Where it stands at a time, in place of `pos`. What moves while the shutter is open is blurred. A model whose materials \
     emit is rendered standing still, where it is when the shutter opens, with a warning.",
);

/// The declaration of `keyframe`.
pub static KEYFRAME_BLOCK: Block = Block::new(
    "keyframe",
    "Where a camera or a model stands at a time, as later versions write it. Between two of them it moves evenly and \
     turns evenly, the shorter way; before the first and after the last it stands still. Of several at one time the last \
     counts from then on: it jumps there.",
    &[
        Field::new(
            "time",
            Kind::Real,
            Presence::Default("0"),
            "The time: the shutter opens at 0 and closes at 1.",
        ),
        Field::new("pos", Kind::Vec3, Presence::Required, "Where its origin stands.").unit("m"),
        Field::new(
            "rotation_quaternion",
            Kind::Block(&ROTATION_QUATERNION),
            Presence::Optional,
            "How it is turned, after the rotation that it has besides; not at all where it is missing.",
        ),
    ],
)
.with_example(
    "<keyframe>
    <time>0</time>
    <pos>0 0 1</pos>
    <rotation_quaternion><axis>0 0 1</axis><angle>0.5</angle></rotation_quaternion>
</keyframe>",
);

/// The declaration of `rotation_quaternion`.
pub static ROTATION_QUATERNION: Block = Block::new(
    "rotation_quaternion",
    "A turn by an angle, clockwise for someone towards whom the axis points.",
    &[
        Field::new(
            "axis",
            Kind::Vec3,
            Presence::Required,
            "The axis, of any length; at 0 nothing is turned.",
        ),
        Field::new("angle", Kind::Real, Presence::Required, "The angle.").unit("rad"),
    ],
)
.with_example("<rotation_quaternion><axis>0 0 1</axis><angle>1.5708</angle></rotation_quaternion>");

/// The declaration of `white_point`.
pub static WHITE_POINT: Block = Block::new(
    "white_point",
    "A white.",
    &[Field::new(
        "chromaticity_coordinates",
        Kind::Block(&CHROMATICITY),
        Presence::Required,
        "Its CIE 1931 chromaticity.",
    )],
)
.with_example(
    "<white_point><chromaticity_coordinates><x>0.3457</x><y>0.3585</y></chromaticity_coordinates></white_point>",
);

/// The declaration of `chromaticity_coordinates`.
pub static CHROMATICITY: Block = Block::new(
    "chromaticity_coordinates",
    "A chromaticity of the CIE 1931 standard observer; x + y is at most 1.",
    &[
        Field::new("x", Kind::Real, Presence::Required, "The share of X.").range(Range::Above(0.0)),
        Field::new("y", Kind::Real, Presence::Required, "The share of Y.").range(Range::Above(0.0)),
    ],
)
.with_example("<chromaticity_coordinates><x>0.3457</x><y>0.3585</y></chromaticity_coordinates>");

/// The declaration of `bloom`.
pub static BLOOM: Block = Block::new(
    "bloom",
    "A glow: a blurred copy of the picture is added to it.",
    &[
        Field::new("weight", Kind::Real, Presence::Required, "The share of the picture that is added.")
            .range(Range::AtLeast(0.0)),
        Field::new(
            "radius",
            Kind::Real,
            Presence::Required,
            "Standard deviation of the blur, as a fraction of the larger side of the picture.",
        )
        .range(Range::AtLeast(0.0)),
    ],
)
.with_example("<bloom><weight>0.1</weight><radius>0.05</radius></bloom>");

/// The declaration of `aperture_shape`.
pub static APERTURE_SHAPE: Block = Block::new(
    "aperture_shape",
    "The shape of the aperture. A picture of it is saved beside the render, as `aperture_preview.png`.",
    &[],
)
.with_alternatives(Alternatives::new("shape", &[&CIRCULAR, &IMAGE, &GENERATED]))
.with_example("<aperture_shape><circular/></aperture_shape>");

/// The declaration of `circular`.
pub static CIRCULAR: Block =
    Block::new("circular", "A circle. It has no parameters.", &[]).with_example("<circular/>");

/// The declaration of `image`.
pub static IMAGE: Block = Block::new(
    "image",
    "An aperture drawn in an image: white lets light through, black stops it. The white part should \
     touch the edges of the image, or time is wasted.",
    &[Field::new(
        "path",
        Kind::Path,
        Presence::Required,
        "A square greyscale PNG file, relative to the scene file; its side is a power of two from 512 to 4096 \
         pixels. Grey lets a part of the light through, in proportion to the stored value.",
    )],
)
.with_example("<image><path>aperture.png</path></image>");

/// The declaration of `generated`.
pub static GENERATED: Block = Block::new(
    "generated",
    "A diaphragm of curved blades. Each blade's edge is part of a circle of radius `blade_curvature_radius` \
     whose nearest point lies at `blade_offset` from the centre, in the direction of the blade: blade i of n \
     lies at `start_angle` + 2π·i/n, counter-clockwise from the right as the camera looks. A point is open \
     if it lies inside all circles, and inside the square of the shape. A large radius makes straight edges; \
     one that equals the offset makes a circle. [Drawing](generated-aperture.svg).",
    &[
        Field::new("num_blades", Kind::Int, Presence::Required, "Number of blades, at most 10000.")
            .range(Range::AtLeast(3.0)),
        Field::new("start_angle", Kind::Real, Presence::Required, "Angle of the first blade.").unit("rad"),
        Field::new(
            "blade_offset",
            Kind::Real,
            Presence::Required,
            "Distance from the centre to the edge of a blade.",
        )
        .unit("widths of the shape")
        .range(Range::Above(0.0)),
        Field::new(
            "blade_curvature_radius",
            Kind::Real,
            Presence::Required,
            "Distance from the edge of a blade to the centre of its curvature; more than half the offset, or the \
             blades close.",
        )
        .unit("widths of the shape")
        .range(Range::Above(0.0)),
    ],
)
.with_example(
    "<generated>
    <num_blades>6</num_blades>
    <start_angle>0.2</start_angle>
    <blade_offset>0.3</blade_offset>
    <blade_curvature_radius>1.2</blade_curvature_radius>
</generated>",
);
