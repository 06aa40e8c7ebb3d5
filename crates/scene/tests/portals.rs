//! Exit portals: openings that none covers are found, and portals that can have no effect are named.

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_scene::{LoadOptions, load};

struct Memory(String);

impl Resolver for Memory {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        match path {
            "scene.igs" => Ok(Resolved { path: path.to_owned(), bytes: self.0.as_bytes().into() }),
            _ => Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        }
    }
}

/// A mesh of one quadrilateral.
fn quad(name: &str, corners: [[i32; 3]; 4]) -> String {
    let vertices = corners.map(|[x, y, z]| format!("<vertex pos=\"{x} {y} {z}\"/>")).concat();
    format!(
        "<mesh><name>{name}</name><normal_smoothing>false</normal_smoothing><embedded>{vertices}<triangle_set><material_name>white</material_name><tri>0 1 2</tri><tri>0 2 3</tri></triangle_set></embedded></mesh>"
    )
}

/// A room from -2 to 2 about the camera at (10, 0, 0), without its walls at ±y, and what is in them.
fn codes(more: &str, light: &str) -> Vec<(&'static str, String)> {
    let head = "<scene><renderer_settings><aperture_diffraction>false</aperture_diffraction><bidirectional>false</bidirectional><metropolis>false</metropolis></renderer_settings>
<tonemapping><linear><scale>1</scale></linear></tonemapping>
<camera><pos>10 0 0</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1.3333</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist></camera>
<material><name>white</name><diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse></material>";
    let (a, b) = (-2, 2);
    let walls = [
        quad("low", [[a, a, a], [b, a, a], [b, b, a], [a, b, a]]),
        quad("high", [[a, a, b], [a, b, b], [b, b, b], [b, a, b]]),
        quad("left", [[a, a, a], [a, b, a], [a, b, b], [a, a, b]]),
        quad("right", [[b, a, a], [b, a, b], [b, b, b], [b, b, a]]),
        // Fronts towards the middle.
        quad("north", [[a, b, a], [b, b, a], [b, b, b], [a, b, b]]),
        quad("south", [[a, a, a], [a, a, b], [b, a, b], [b, a, a]]),
    ];
    let models: String = ["low", "high", "left", "right"].map(|name| placed("model", name)).concat();
    let text = format!("{head}{light}{}{models}{more}</scene>", walls.concat());
    let resolver = Memory(text);
    let loaded = load("scene.igs", &LoadOptions::new(&resolver));
    loaded.sink.diagnostics().iter().map(|d| (d.code, format!("{} {:?}", d.message, d.notes))).collect()
}

fn placed(element: &str, mesh: &str) -> String {
    format!("<{element}><pos>10 0 0</pos><scale>1</scale><mesh_name>{mesh}</mesh_name></{element}>")
}

fn turned(mesh: &str) -> String {
    placed("exit_portal", mesh)
        .replace("</scale>", "</scale><rotation><matrix>1 0 0 0 -1 0 0 0 -1</matrix></rotation>")
}

const SKY: &str = "<skylight><sundir>0 0.5 1</sundir><turbidity>2</turbidity></skylight>";

#[test]
fn openings_without_a_portal_are_found() {
    let (north, south) = (placed("exit_portal", "north"), placed("exit_portal", "south"));
    assert_eq!(codes(&format!("{north}{south}"), SKY), []);
    let half = codes(&north, SKY);
    assert_eq!(half.len(), 1, "{half:?}");
    assert!(half[0].0 == "W0312" && half[0].1.contains("beside the exit portals"), "{half:?}");
    // One of them leaves from near the camera.
    assert!(half[0].1.contains("one of them from (10.000 0.000 0.000)"), "{half:?}");
    // One that is too small leaves an opening round it, and one that was made too small covers it at twice its size.
    let small = north.replace("<scale>1<", "<scale>0.5<").replace("10 0 0", "10 1 0");
    assert_eq!(codes(&format!("{small}{south}"), SKY).len(), 1);
    let half = quad("half", [[-1, 1, -1], [1, 1, -1], [1, 1, 1], [-1, 1, 1]]);
    let grown = placed("exit_portal", "half").replace("<scale>1<", "<scale>2<");
    assert_eq!(codes(&format!("{half}{grown}{south}"), SKY), []);
    // No portal, no complaint.
    assert_eq!(codes("", SKY), []);
}

/// A pane closes no opening: light passes it.
#[test]
fn openings_behind_panes_are_found() {
    let glass = "<medium><name>glass</name><precedence>10</precedence><basic><ior>1.5</ior><absorption_coefficient_spectrum><uniform><value>0</value></uniform></absorption_coefficient_spectrum></basic></medium>";
    let kinds = [
        "<specular><transparent>true</transparent><internal_medium_name>glass</internal_medium_name></specular>",
        "<null_material/>",
        "<diffuse_transmitter><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse_transmitter>",
        "<blend><blend_factor>0.5</blend_factor><a_name>white</a_name><b_name>paper</b_name></blend>",
    ];
    let paper = format!("<material><name>paper</name>{}</material>", kinds[2]);
    let pane = |kind: &str| {
        let sheet = |name: &str, y: i32| quad(name, [[-2, y, -2], [-2, y, 2], [2, y, 2], [2, y, -2]]);
        let sheets = sheet("inner", -2)
            + &sheet("outer", -2).replace("\"-2 -2 ", "\"-2 -2.01 ").replace("\"2 -2 ", "\"2 -2.01 ");
        let material = format!("<material><name>pane</name>{kind}</material>");
        let sheets = sheets.replace(">white<", ">pane<");
        format!(
            "{glass}{paper}{material}{sheets}{}{}{}",
            placed("model", "inner"),
            placed("model", "outer"),
            placed("exit_portal", "north")
        )
    };
    for kind in kinds {
        let found = codes(&pane(kind), SKY);
        let of_openings: Vec<_> = found.iter().filter(|f| f.0 == "W0312").collect();
        assert_eq!(of_openings.len(), 1, "{kind}: {found:?}");
        assert!(of_openings[0].1.contains("beside the exit portals"), "{found:?}");
    }
    // What only reflects closes it, and so does a wall.
    assert_eq!(codes(&pane(&kinds[0].replace(">true<", ">false<")).replace(&paper, ""), SKY), []);
    let wall = placed("model", "south") + &placed("exit_portal", "north");
    assert_eq!(codes(&wall, SKY), []);
}

#[test]
fn a_portal_that_shows_its_back_is_named() {
    // Turned by half about x, the southern one lies in the north, with its front to the room: well.
    assert_eq!(codes(&format!("{}{}", turned("south"), placed("exit_portal", "south")), SKY), []);
    // Mirrored in the plane y = 0, the southern one lies in the north, and its front stays a front.
    let mirrored = turned("south").replace("1 0 0 0 -1 0 0 0 -1", "1 0 0 0 -1 0 0 0 1");
    assert_eq!(codes(&format!("{mirrored}{}", placed("exit_portal", "south")), SKY), []);
    // Moved to the other side without a turn, it is a back.
    let moved = placed("exit_portal", "north").replace("10 0 0", "10 -4 0");
    let found = codes(&format!("{moved}{}", placed("exit_portal", "north")), SKY);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].0 == "W0312" && found[0].1.contains("back of an exit portal"), "{found:?}");
}

#[test]
fn portals_without_light_outside_have_no_effect() {
    let lamp = "<rectanglelight><pos>10 0 1</pos><width>1</width><height>1</height><spectrum><uniform><value>1</value></uniform></spectrum></rectanglelight>";
    let found = codes(&placed("exit_portal", "north"), lamp);
    assert_eq!(found.iter().map(|f| f.0).collect::<Vec<_>>(), ["W0311"]);
    let unknown = codes(&placed("exit_portal", "nothing"), SKY);
    assert_eq!(unknown.iter().map(|f| f.0).collect::<Vec<_>>(), ["E0301"]);
}
