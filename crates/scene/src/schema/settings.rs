//! Render settings, declared.

use super::emission::LAYER_SETTING;
use super::filter::{DOWNSIZE_FILTER, SPLAT_FILTER};
use indigo_decl::{Block, Field, Kind, Later, Presence, Range};

/// The most threads that may be asked for.
pub const MOST_THREADS: usize = 1024;

const fn flag(name: &'static str, default: &'static str, doc: &'static str) -> Field {
    Field::new(name, Kind::Bool, Presence::Default(default), doc)
}

const fn count(name: &'static str, default: &'static str, doc: &'static str) -> Field {
    Field::new(name, Kind::Int, Presence::Default(default), doc).range(Range::Above(0.0))
}

const fn real(name: &'static str, default: &'static str, doc: &'static str) -> Field {
    Field::new(name, Kind::Real, Presence::Default(default), doc)
}

/// The declaration of `renderer_settings`.
pub static RENDERER_SETTINGS: Block = Block::new(
    "renderer_settings",
    "How to render. Every setting is optional. What is said here overrides `inifile.xml`, whose root \
     element holds the same settings; the command line overrides both.",
    &[
        count("width", "600", "Width of the picture.").unit("pixels"),
        count("height", "450", "Height of the picture.").unit("pixels"),
        count(
            "bih_tri_threshold",
            "1100000",
            "Meshes with more triangles than this get a tree that is quick to build and small, the others one \
             that is quick to trace.",
        )
        .unit("triangles"),
        flag(
            "metropolis",
            "true",
            "Whether paths are chosen by Metropolis sampling. That pays where light is hard to find, through gaps and behind \
             several surfaces; where lamps or the sky are open to view, pictures have less noise without it.",
        ),
        real(
            "large_mutation_prob",
            "0.4",
            "Probability of a large mutation, which starts afresh. Used with `metropolis`.",
        )
        .range(Range::Within(0.0, 1.0)),
        real("max_change", "0.01", "Radius of the small mutations. Used with `metropolis`.")
            .range(Range::Within(0.0, 1.0)),
        count(
            "max_depth",
            "10000",
            "Largest number of scattering events between the camera and the light; at 0 only what shines straight \
             into the lens is seen.",
        )
        .unit("bounces")
        .range(Range::AtLeast(0.0)),
        count(
            "max_num_consec_rejections",
            "1000",
            "Largest number of mutations that may be rejected in a row. Used with `metropolis`. Strictly \
             speaking any finite number biases the picture.",
        )
        .unit("rejections"),
        flag("logging", "true", "Whether the console's output is also written to `log.txt`."),
        flag(
            "bidirectional",
            "true",
            "Whether paths are built from both ends. Otherwise from the camera only.",
        ),
        flag(
            "save_untonemapped_exr",
            "false",
            "Whether an EXR picture of the luminances is saved beside the PNG: linear Rec. 709 in cd/m², with diffraction, \
             without tone mapping, white balance and exposure; with `render_foreground_alpha` the mask.",
        ),
        flag(
            "save_tonemapped_exr",
            "false",
            "Whether an EXR picture of the tone-mapped colours, linear on the display, is saved beside the PNG.",
        ),
        flag(
            "save_layers_exr",
            "false",
            "Whether an EXR with layers is saved beside the PNG: the whole picture in cd/m² (`R`, `G`, `B`); the foreground's light \
             without the surroundings (`foreground.R`, `foreground.G`, `foreground.B`) with the part of the pixel that it covers \
             (`foreground.A`, by the same filters as the light, but without diffraction), premultiplied, so that `foreground` goes over any \
             other picture; the light that the surroundings send \
             straight into the camera (`background.R`, `background.G`, `background.B`), which with the foreground's makes up \
             the picture; its light that was scattered once at most (`direct.R`, `direct.G`, `direct.B`) and more often (`indirect.R`, \
             `indirect.G`, `indirect.B`), which make up the picture, too; the light of each `layer_setting` whose lights the scene has, as bright as it is in the picture (`light1.R` and so on, in their order; the attribute `indigo.light_names` tells their names); and of what the camera first meets the reflectance (`albedo.R`, `albedo.G`, `albedo.B`), the normal in the world \
             (`normal.X`, `normal.Y`, `normal.Z`), the depth in metres (`depth.Z`, 1e10 where there is nothing), and \
             the numbers of object and material that most of the pixel shows (`object_id.X`, `material_id.X`, 0 where there is nothing). \
             The attributes `indigo.object_names` and `indigo.material_names` tell their names, as JSON: objects are numbered \
             from 1 as models, spheres, planes, mesh lights and rectangle lights in the order of the scene, materials as objects use them; a \
             model is one for each of its materials that emit, and one for the rest. Takes \
             sixteen camera rays per pixel, once, and two to three times the memory for the film.",
        ),
        flag(
            "denoise",
            "false",
            "Whether a denoised picture is saved beside the PNG, which stays as it is, and of each EXR that is asked for, too. \
             Needs the library Open Image Denoise, version 2; without it a warning is given.",
        ),
        flag(
            "save_igi",
            "false",
            "Whether the film is saved as an Indigo image, from which rendering can go on.",
        ),
        real("image_save_period", "10", "How often the pictures are saved.").unit("s").range(Range::Above(0.0)),
        real("halt_time", "-1", "Rendering halts after this time. Never, if not positive.").unit("s"),
        real(
            "halt_samples_per_pixel",
            "-1",
            "Rendering halts at this number of samples per pixel of the whole picture, or a little above it: a \
             fraction is rounded up, as are the mutations of `metropolis` to some thousands, and the samples of a \
             `render_region` so that each of its pixels gets the same. Never, if not positive.",
        )
        .unit("samples/pixel"),
        flag(
            "hybrid",
            "false",
            "Whether direct light is sampled by low-discrepancy points and the rest by Metropolis sampling, whatever \
             `metropolis` says.",
        ),
        real("frame_upload_period", "40", "How often a network slave sends its film to the master.")
            .unit("s")
            .range(Range::Above(0.0)),
        flag(
            "auto_choose_num_threads",
            "true",
            "Whether there are as many threads as the machine has logical cores.",
        ),
        count(
            "num_threads",
            "1",
            "Number of threads, without `auto_choose_num_threads`. At most 1024: more than any machine for which this \
             is meant has cores, and few enough that each may hold a film of its own.",
        )
        .unit("threads")
        .range(Range::Within(1.0, MOST_THREADS as f64)),
        count(
            "super_sample_factor",
            "2",
            "The picture is rendered this many times larger in both directions and then made smaller, which \
             smooths bright edges. Memory grows with its square.",
        ),
        real(
            "display_period",
            "10",
            "How often the picture on the screen is renewed; the console prints a line of progress as often, but no \
             more than ten a second, unless it renews its line on a terminal.",
        )
            .unit("s")
            .range(Range::Above(0.0)),
        real(
            "ray_origin_nudge_distance",
            "1.0e-4",
            "Rays start at least this far from the surface that they leave, and surfaces that stand closer than \
             this behind another one may be missed. 0 leaves it to the rounding-error bound of each hit.",
        )
        .unit("m")
        .range(Range::AtLeast(0.0)),
        flag(
            "watermark",
            "false",
            "Whether the name of the program is drawn into the lower right corner of the PNG and of the tone-mapped EXR.",
        ),
        Field::new(
            "png_bits",
            Kind::Choice(&["8", "16"]),
            Presence::Default("8"),
            "Bits of each colour component in the PNG.",
        ),
        flag(
            "dithering",
            "false",
            "Whether each component in the PNG is one of the two nearest codes by chance, so that smooth gradients \
             have no bands, instead of always the nearest.",
        ),
        flag("cache_trees", "true", "Whether the trees of meshes are kept on disk for the next time."),
        flag("aperture_diffraction", "true", "Whether light is diffracted by the aperture of the camera."),
        flag(
            "post_process_diffraction",
            "true",
            "Whether that diffraction is a filter on the picture (faster, less noise, slightly less exact) \
             instead of a deflection of rays. The filter spreads all light as it does white light: rings and streaks of lamps of \
             one colour are up to a fifth larger or smaller than by rays. And what it would throw out of the picture it leaves where it came from, \
             so that the totals stay; in pictures from 36 mm sensors that is about 1e-4 of the light.",
        ),
        flag(
            "vignetting",
            "true",
            "Whether the picture darkens towards its corners, by the cos⁴ law. Needs the camera's consent, too.",
        ),
        flag(
            "placeholders",
            "false",
            "Whether a texture or a mesh whose file is missing is no error but a warning: magenta and black squares stand in for \
             the texture, and a magenta cube of a metre for the mesh. A missing mesh of an `exit_portal` leaves that out. `--pack` and \
             `--upgrade` write a scene that lacks such files only with it; the scene that they write names them by the paths that it had.",
        ),
        Field::new(
            "render_region",
            Kind::Block(&RENDER_REGION),
            Presence::Optional,
            "Renders only a part of the picture, which is otherwise black. What `reinhard` adapts itself to is the part then: \
             `linear` and `camera` show it as in the whole picture.",
        ),
        flag(
            "render_foreground_alpha",
            "false",
            "Whether the picture shows only what hides the background: white where there is something, black \
             where the surroundings are seen, and grey in between along edges; without diffraction, which spreads light \
             and not the things that it comes from (linear in every EXR, sRGB-encoded in \
             the PNG as all pictures are, so that half covered is 188 of 255). Such a film holds no light, and is developed \
             with this setting only. Rendered by camera rays alone, \
             whatever `metropolis`, `hybrid`, `bidirectional` and `max_depth` say.",
        ),
        Field::new(
            "splat_filter",
            Kind::Block(&SPLAT_FILTER),
            Presence::Optional,
            "How samples are spread over pixels: `gaussian` where it is missing.",
        ),
        Field::new(
            "downsize_filter",
            Kind::Block(&DOWNSIZE_FILTER),
            Presence::Optional,
            "How a super-sampled picture is made smaller: `mn_cubic` where it is missing.",
        ),
        Field::new(
            "layer_setting",
            Kind::Block(&LAYER_SETTING),
            Presence::Repeated,
            "How bright the emitting materials of a layer shine; as they are, where it is missing.",
        ),
    ],
)
.with_later(LATER)
.with_ignored(&["russian_roulette_live_prob", "strata_width"])
.with_example(
    "<renderer_settings>
    <metropolis>true</metropolis>
    <bidirectional>true</bidirectional>
    <width>800</width>
    <height>600</height>
    <downsize_filter>
        <mn_cubic><ring>0.2</ring><blur>0.6</blur></mn_cubic>
    </downsize_filter>
    <splat_filter><gaussian/></splat_filter>
    <super_sample_factor>2</super_sample_factor>
    <aperture_diffraction>true</aperture_diffraction>
    <post_process_diffraction>true</post_process_diffraction>
</renderer_settings>",
);

/// The declaration of `render_region`.
pub static RENDER_REGION: Block = Block::new(
    "render_region",
    "The part of the picture to render: the pixels with x1 ≤ x < x2 and y1 ≤ y < y2, counted from the \
     top left corner, with x2 ≤ width and y2 ≤ height.",
    &[
        corner("x1", "First column.", Range::AtLeast(0.0)),
        corner("y1", "First row.", Range::AtLeast(0.0)),
        corner("x2", "Column after the last one; greater than x1.", Range::Above(0.0)),
        corner("y2", "Row after the last one; greater than y1.", Range::Above(0.0)),
    ],
)
.with_example("<render_region><x1>10</x1><y1>10</y1><x2>110</x2><y2>60</y2></render_region>");

const fn corner(name: &'static str, doc: &'static str, range: Range) -> Field {
    Field::new(name, Kind::Int, Presence::Required, doc).unit("pixels").range(range)
}

/// Settings of later versions.
const LATER: &[Later] = &[
    Later::new("info_overlay", "1.1"),
    Later::new("white_point", "1.1"),
    Later::new("save_png", "2.0"),
    Later::new("save_jpeg", "2.0"),
    Later::new("verbose", "2.0"),
    Later::new("write_aperture_preview", "2.0"),
    Later::new("material_id_tracer", "2.0"),
    Later::new("depth_pass", "2.0"),
    Later::new("shadow_pass", "3.0"),
    Later::new("merging", "3.0"),
    Later::new("gpu", "3.0"),
    Later::new("gpu_max_depth", "4.0"),
    Later::new("batched", "3.0"),
    Later::new("glass_acceleration", "3.0"),
    Later::new("close_gui_on_halt", "3.0"),
    Later::new("save_images_on_close", "3.0"),
    Later::new("clamp_contributions", "4.0"),
    Later::new("max_contribution", "4.0"),
    Later::new("optimise_for_denoising", "4.0"),
    Later::new("colour_curves", "4.0"),
    Later::new("normals_channel", "4.0"),
    Later::new("depth_channel", "4.0"),
    Later::new("position_channel", "4.0"),
    Later::new("albedo_channel", "4.0"),
    Later::new("material_id_channel", "4.0"),
    Later::new("object_id_channel", "4.0"),
    Later::new("spectral_channel", "4.0"),
];
