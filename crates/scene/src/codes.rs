//! The stable codes of diagnostics that come from lowering a scene.

indigo_decl::codes! {
    /// A name or uid that is defined twice, of which the last definition counts, or that every scene has itself.
    DUPLICATE_NAME = "W0302", "<material><name>a</name><null_material/></material><material><name>a</name><diffuse/></material>";
    /// Something about a mesh, picture or lamp file that its user should know.
    FILE_NOTE = "W0303", "<mesh><name>m</name><embedded></embedded></mesh><model><pos>0 0 0</pos><scale>1</scale><mesh_name>m</mesh_name></model>";
    /// The sensor's aspect ratio is not the picture's.
    ASPECT_RATIO = "W0304", "<renderer_settings><width>800</width><height>100</height></renderer_settings>";
    /// A scene without `tonemapping`.
    NO_TONEMAPPING = "W0305", "(a scene without `tonemapping`)";
    /// A scene without light.
    NO_LIGHT = "W0306", "(a scene without `background`, `background_settings`, `skylight`, `env_map`, `meshlight`, `rectanglelight` and emitting materials)";
    /// The normal of a plane is not of length 1.
    NOT_UNIT = "W0307", "<plane><normal>0 0 2</normal><dist>0</dist><material_name>white</material_name></plane>";
    /// Texels that cannot be light.
    BAD_TEXELS = "W0308", "(a picture with texels that are no numbers, or an environment map with negative ones)";
    /// A lamp whose flux is given twice.
    FLUX_TWICE = "W0310", "(a `meshlight` with `ies_profile` and `efficacy_scale`)";
    /// Portals without light outside.
    IDLE_PORTALS = "W0311", "(an `exit_portal` without `background`, `skylight` and `env_map`)";
    /// Openings that no portal covers.
    UNCOVERED = "W0312", "(a room with two windows and one `exit_portal`)";
    /// A photometric lamp whose mesh is not flat.
    NOT_FLAT = "W0313", "(a bent `meshlight` with `ies_profile`)";
    /// An efficacy that no lamp can have.
    EFFICACY = "W0314", "(a lamp of 100 W and 700 lm/W)";
    /// An object whose shape is lost to rounding.
    ROUNDED = "W0315", "(a lamp of a metre, a million kilometres from the camera)";
    /// A turbidity beyond what the model of the sky knows.
    TURBIDITY = "W0309", "<skylight><sundir>0 0.6 1</sundir><turbidity>30</turbidity></skylight>";
    /// What moves is rendered standing still.
    STANDS_STILL = "W0317", "(a `model` that shines, with two `keyframe`s in different places)";
    /// A model that lists fewer materials than its mesh has.
    MATERIAL_COUNT = "W0318", "(a `model` whose `materials` are one, of a mesh with two)";
    /// Something of an emitting material that gives no light.
    NOT_EMITTING = "W0319", "(a `sphere` whose material has `base_emission`)";
    /// A kind of a later format version that another stands in for.
    STANDS_IN = "W0320", "<material><name>a</name><fast_sss></fast_sss></material><sphere><center>0 0 0</center><radius>1</radius><material_name>a</material_name></sphere>";
    /// A scale or a profile of a material that the model does not emit by.
    IDLE_SCALE = "W0321", "(an `emission_scale` of a material that the model does not have)";
    /// A map of exponents with some that are not above 0.
    NO_EXPONENT = "W0322", "(an `exponent_map` of a picture with black texels)";
    /// A medium whose mean free path is near the rounding of its surface.
    TOO_DENSE = "W0323", "(a box of a metre whose medium scatters 100,000 times a metre)";
    /// A camera whose white is given twice.
    WHITE_TWICE = "W0324", "(a `camera` with `white_balance` and `white_point`)";
    /// Something that only a lens makes use of, for a camera without one.
    NO_LENS = "W0325", "(an orthographic `camera` with an `obstacle_map`)";
    /// A file that cannot be had, which something stands in for.
    PLACEHOLDER = "W0326", "<renderer_settings><placeholders>true</placeholders></renderer_settings><mesh><name>m</name><external><path>none.obj</path></external></mesh><model><pos>0 0 0</pos><scale>1</scale><mesh_name>m</mesh_name></model>";
    /// A file that cannot be had, named by something that has no effect; told by `-check`.
    IDLE_MISSING = "W0327", "(a texture with `<path>nowhere.png</path>` of a material that nothing uses)";
    /// A map of fractions with some below 0 or above 1.
    BEYOND_FRACTIONS = "W0328", "(a `blend_map` with `<b>3</b>`)";
    /// A mesh that bounds a medium and is not closed.
    NOT_CLOSED = "W0329", "(a square whose material has an `internal_medium_name`)";
    /// A turn between neighbouring keys that goes the other, shorter way.
    LONG_TURN = "W0330", "(a `model` with `keyframe`s whose angles about one axis are 0 and 5)";
    /// An image map on a mesh without texture coordinates.
    NO_COORDINATES = "W0331", "(a material with an image map, on a mesh that exposes no uv set)";
    /// A name that nothing defines.
    UNKNOWN_NAME = "E0301", "<sphere><center>0 0 0</center><radius>1</radius><material_name>whiet</material_name></sphere>";
    /// A file that cannot be had.
    MISSING_FILE = "E0302", "<env_map><latlong><path>nowhere.exr</path><gain>1</gain></latlong></env_map>";
    /// A file that cannot be understood.
    BAD_FILE = "E0303", "<env_map><latlong><path>scene.igs</path><gain>1</gain></latlong></env_map>";
    /// A transformation that cannot be inverted, or directions that span no plane.
    SINGULAR = "E0304", "<plane><normal>0 0 0</normal><dist>0</dist><material_name>white</material_name></plane>";
    /// A scene without a camera.
    NO_CAMERA = "E0305", "(a scene without `camera`)";
    /// Geometry that cannot be built.
    GEOMETRY = "E0306", "<sphere><center>0 0 0</center><radius>1e30</radius><material_name>white</material_name></sphere>";
    /// A texture on a mesh without the texture coordinates that it asks for.
    NO_UV_SET = "E0307", "(a material with `uv_set` on a mesh that does not expose a set of that name)";
    /// A lamp whose power is given but that has no light to scale.
    NO_FLUX = "E0308", "<rectanglelight><pos>0 0 3</pos><width>1</width><height>1</height><spectrum><uniform><value>0</value></uniform></spectrum><efficacy_scale><power_drawn>100</power_drawn><overall_luminous_efficacy>17.5</overall_luminous_efficacy></efficacy_scale></rectanglelight>";
    /// A name of a white that is not known.
    UNKNOWN_WHITE = "E0309", "<camera><pos>0 0 0</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1.3333</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist><white_balance>D66</white_balance></camera>";
    /// A picture or a region of impossible size.
    PICTURE_SIZE = "E0310", "<renderer_settings><width>200000</width></renderer_settings>";
    /// A plane where light is traced from both ends.
    PLANE_BIDIRECTIONAL = "E0311", "<renderer_settings><bidirectional>true</bidirectional></renderer_settings><plane><normal>0 0 1</normal><dist>0</dist><material_name>white</material_name></plane>";
    /// A material that is made of itself, or of others too deep.
    BLEND_CYCLE = "E0312", "(a blend that names itself)";
    /// A file that a packed scene lacks.
    NOT_PACKED = "W0316", "(`--pack` of a scene with `<path>nowhere.png</path>`)";
    /// A path that cannot be rewritten where a scene is packed.
    NOT_REWRITABLE = "E0313", "(`--pack` of a scene with `<path>a<![CDATA[.png]]></path>`)";
    /// More media than can be told apart.
    TOO_MANY_MEDIA = "E0320", "(more than 65535 media)";
}
