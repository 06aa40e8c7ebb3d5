//! Prints the reference of the scene format, for `docs/manual/scene-format.md`.

fn main() {
    print!("{}", indigo_scene::schema::reference());
}
