//! The scenes that both renderers render.

use super::super::hung;
use super::super::shapes::{Mesh, Point};
use super::stage::{Index, Map, Shape, Stage, Surface, Tone, View};

/// A scene, what it shows, and which share of a value a known difference of models may take.
pub struct Entry {
    /// A few words.
    pub name: &'static str,
    /// What is in it, and what differs between the models.
    pub about: &'static str,
    /// That share; 0 where the models are one.
    pub slack: f64,
    /// Whether it has colours.
    pub is_coloured: bool,
    /// How many times as many samples as the scenes of the least noise it needs.
    pub effort: u32,
    /// How many times as many samples the full form takes, so that half a percent of each region is seen by both.
    pub fine: u32,
    /// The scene.
    pub stage: Stage,
}

impl Entry {
    fn new(name: &'static str, about: &'static str, stage: Stage) -> Self {
        Self { name, about, slack: 0.0, is_coloured: false, effort: 4, fine: 4, stage }
    }
}

/// A square of a half side whose front looks along an axis, `d` away from the origin on the other side.
fn wall(towards: Point, d: f64, half: f64) -> Shape {
    Shape::Triangles(Mesh::polygon(hung::corners(towards.map(|x| -x * d), towards, half).to_vec()))
}

fn matt(albedo: f64) -> Surface {
    Surface::Matt(Tone::Even(albedo))
}

/// A room of side 2 round the origin, open towards the camera, of floor, left and right wall, and the rest.
fn room([floor, left, right, rest]: [Surface; 4]) -> Vec<(Shape, Surface)> {
    vec![
        (wall([0.0, 0.0, 1.0], 1.0, 1.0), floor),
        (wall([0.0, 0.0, -1.0], 1.0, 1.0), rest.clone()),
        (wall([1.0, 0.0, 0.0], 1.0, 1.0), left),
        (wall([-1.0, 0.0, 0.0], 1.0, 1.0), right),
        (wall([0.0, -1.0, 0.0], 1.0, 1.0), rest),
    ]
}

fn white_room() -> Vec<(Shape, Surface)> {
    room([matt(0.5), matt(0.7), matt(0.7), matt(0.7)])
}

fn block(surface: Surface) -> (Shape, Surface) {
    let (c, s) = (0.3 * 0.9, 0.3 * 0.435_889_894);
    let mesh = Mesh::cube(1.0).placed([c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 0.3], 1.0, [0.3, 0.2, -0.69]);
    (Shape::Triangles(mesh), surface)
}

fn lamp(half: f64, tone: Tone) -> (Shape, Surface) {
    (wall([0.0, 0.0, -1.0], 0.98, half), Surface::Lamp(tone))
}

fn view() -> View {
    View { eye: [0.0, -3.6, 0.0], target: [0.0; 3], tangent: 0.42, lens: None }
}

/// The white room with a lamp and something in it.
fn in_room(things: Vec<(Shape, Surface)>) -> Stage {
    let things = [white_room(), vec![lamp(0.4, Tone::Even(10.0))], things].concat();
    Stage { view: view(), things, around: 0.0, map: None }
}

/// Something on a floor in even light.
fn in_even_light(surface: Surface) -> Stage {
    let things = vec![(wall([0.0, 0.0, 1.0], 1.0, 4.0), matt(0.5)), (Shape::Ball([0.0; 3], 0.95), surface)];
    Stage { view: View { eye: [0.0, -6.0, 1.5], tangent: 0.3, ..view() }, things, around: 1.0, map: None }
}

fn ball(center: Point, radius: f64, surface: Surface) -> (Shape, Surface) {
    (Shape::Ball(center, radius), surface)
}

/// As it comes with Indigo.
const GOLD: Index = Index::Shipped(include_str!("../../../../../nkdata/au.nk"));

/// A picture that looks like itself neither mirrored, nor upside down, nor turned: a bright L with a grey foot, darker to the right.
fn sign() -> Map {
    Map::new([8, 8], |x, y| match (x, y) {
        (1..=2, 1..=6) => 20.0,
        (3..=6, 5..=6) => 9.0,
        _ => 2.0 - 0.2 * x as f32,
    })
}

/// The white room, lit by a picture on its back wall.
fn sign_in_room() -> Stage {
    let square = hung::corners([0.1, 0.95, 0.1], [0.0, -1.0, 0.0], 0.6);
    let things = vec![(Shape::Square(square), Surface::Screen(sign())), block(matt(0.4))];
    Stage { view: view(), things: [white_room(), things].concat(), around: 0.0, map: None }
}

/// All of them.
pub fn all() -> Vec<Entry> {
    [surfaces(), bodies(), lights()].into_iter().flatten().collect()
}

fn surfaces() -> Vec<Entry> {
    let red = Surface::Matt(Tone::Table(vec![0.05, 0.05, 0.1, 0.7, 0.8]));
    let blue = Surface::Matt(Tone::Table(vec![0.6, 0.7, 0.2, 0.05, 0.05]));
    let warm = Tone::Table(vec![2.0, 6.0, 10.0, 14.0, 18.0]);
    let mut coloured = in_room(vec![block(matt(0.4))]);
    coloured.things =
        [room([matt(0.5), red, blue, matt(0.7)]), vec![lamp(0.4, warm), block(matt(0.4))]].concat();
    let steel = Surface::Metal(Index::Constant(2.8, 3.3), 1000.0);
    let mut rough = Entry::new(
        "rough metal",
        "Trowbridge and Reitz's facets of width 0.045 on a metal of n = 2.8, k = 3.3. Indigo gives back what is lost among facets \
         (Kulla and Conty), Mitsuba does not: some 0.1 % of the reflected light.",
        in_even_light(steel),
    );
    rough.slack = 2e-3;
    (rough.effort, rough.fine) = (1, 8);
    let mut frosted = Entry::new(
        "rough glass",
        "Trowbridge and Reitz's facets of the exponent 200, width 0.1, n = 1.5; both lose what would be scattered twice. Masking \
         of the two directions is drawn as one in Indigo and separately in Mitsuba, which differs towards the rim.",
        in_even_light(Surface::Frosted(1.5, 200.0)),
    );
    frosted.slack = 1e-3;
    frosted.effort = 1;
    vec![
        Entry::new("matt box", "Matt walls, a block and a lamp.", in_room(vec![block(matt(0.4))])),
        Entry {
            is_coloured: true,
            ..Entry::new("coloured box", "Walls and a lamp of tabulated spectra.", coloured)
        },
        rough,
        Entry {
            is_coloured: true,
            effort: 1,
            ..Entry::new(
                "gold",
                "A smooth ball of gold, by the table of n and k that comes with Indigo.",
                in_even_light(Surface::Metal(GOLD, 1e12)),
            )
        },
        Entry {
            effort: 1,
            ..Entry::new(
                "smooth glass",
                "A glass ball, n = 1.5, on a matt floor, with its caustic of even light.",
                in_even_light(Surface::Glass(1.5, 0.0)),
            )
        },
        frosted,
    ]
}

fn bodies() -> Vec<Entry> {
    let block_of = |surface: Surface| in_room(vec![block(surface)]);
    vec![
        Entry::new(
            "fog, even phase",
            "A ball of fog that scatters to all sides.",
            in_room(vec![ball([0.0, 0.0, -0.2], 0.6, Surface::Fog(1.0, 0.5, 3.0, 0.0))]),
        ),
        Entry {
            effort: 8,
            fine: 6,
            ..Entry::new(
                "fog, Henyey and Greenstein",
                "A ball of fog that scatters forwards, g = 0.7.",
                in_room(vec![ball([0.0, 0.0, -0.2], 0.6, Surface::Fog(1.0, 0.3, 4.0, 0.7))]),
            )
        },
        Entry::new(
            "fog in glass",
            "Fog of g = −0.3 in a body of n = 1.33.",
            in_even_light(Surface::Fog(1.33, 0.3, 1.5, -0.3)),
        ),
        Entry::new(
            "absorbing glass",
            "A block of glass, n = 1.5, σ = 2/m, under a lamp.",
            block_of(Surface::Glass(1.5, 2.0)),
        ),
    ]
}

fn lights() -> Vec<Entry> {
    let small = vec![
        (
            Shape::Triangles(Mesh::ball(1).placed(
                [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
                0.2,
                [-0.5, -0.2, 0.3],
            )),
            Surface::Lamp(Tone::Even(8.0)),
        ),
        (wall([0.6, 0.0, 0.8], 0.9, 0.2), Surface::Lamp(Tone::Even(15.0))),
        block(matt(0.4)),
    ];
    let lens = Stage { view: View { lens: Some([0.3, 2.6]), ..view() }, ..in_room(vec![block(matt(0.4))]) };
    let mut mapped = in_even_light(matt(0.8));
    mapped.around = 0.0;
    mapped.map = Some(Map::bright_towards([0.5, -0.6, 0.62]));
    let mut environment = Entry::new(
        "environment map",
        "A smooth map in latitude and longitude, 128 × 64. Between texels Mitsuba interpolates from one row's and column's middle to the \
         next, and stretches the map's last column by 1/128.",
        mapped,
    );
    environment.slack = 1e-3;
    environment.effort = 2;
    vec![
        Entry {
            effort: 8,
            fine: 5,
            ..Entry::new(
                "lamps",
                "A ball of 32 triangles, a small leaning square and a large one.",
                in_room(small),
            )
        },
        Entry {
            effort: 8,
            ..Entry::new("thin lens", "An aperture of 0.3 m, focused 2.6 m away, before the room.", lens)
        },
        Entry::new(
            "lamp with a picture",
            "A room lit by a picture of 8 × 8 texels, bilinear between their middles, which looks like itself neither mirrored nor turned.",
            sign_in_room(),
        ),
        environment,
    ]
}
