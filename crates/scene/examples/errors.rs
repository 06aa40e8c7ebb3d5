//! Prints the list of diagnostics, for `docs/manual/errors.md`.

fn main() {
    print!("{}", indigo_scene::schema::errors());
}
