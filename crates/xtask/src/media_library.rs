//! The files of `media/`: liquids, glasses and other dielectrics to be included by scenes, one file each,
//! written from the tables in `crates/xtask/data`.

use std::fmt::Write;

const LIQUIDS: &str = include_str!("../data/liquids.csv");
const DIELECTRICS: &str = include_str!("../data/dielectrics.csv");

/// Where the coefficients of liquids are from.
const LIQUID_SOURCE: &str =
    "Narasimhan et al. 2006, Acquiring Scattering Properties of Participating Media by Dilution";
/// The index of refraction of liquids, which the measurements do not give: water's at the sodium line.
const LIQUID_IOR: &str = "1.333";
/// A liquid may reach into its glass, which displaces it.
const LIQUID_PRECEDENCE: u32 = 10;
const SOLID_PRECEDENCE: u32 = 20;

/// Paths in the repository and contents of all files.
pub fn files() -> Vec<(String, String)> {
    let liquids = rows(LIQUIDS).map(|row| liquid(&row));
    let dielectrics = rows(DIELECTRICS).map(|row| dielectric(&row));
    let media = liquids
        .chain(dielectrics)
        .map(|(name, medium)| (format!("media/{name}.igs"), format!("<scene>\n{medium}</scene>\n")));
    media.chain([("media/README.md".to_owned(), readme())]).collect()
}

/// What there is, as lists.
fn readme() -> String {
    let mut text = format!(
        "# Measured media

Liquids, glasses and other dielectrics: a `medium` each, named as its file, to be included beside a scene or from the resource
directory:

```xml
<include><pathname>media/water.igs</pathname></include>
<material>
    <name>water surface</name>
    <specular><internal_medium_name>water</internal_medium_name></specular>
</material>
```

Written by `cargo xtask gen` from the tables in `crates/xtask/data`.

## Liquids

{LIQUID_SOURCE}. Absorption and scattering, of red, green and blue. Their index of refraction, which was not measured, is
that of water ({LIQUID_IOR}); their precedence is {LIQUID_PRECEDENCE}, so that glass displaces them.

| file | liquid |
|---|---|
"
    );
    for row in rows(LIQUIDS) {
        let _ = writeln!(text, "| {}.igs | {} |", identifier(row[0]), row[0]);
    }
    let _ = write!(
        text,
        "
## Glasses and other dielectrics

Clear, with the index of refraction by Cauchy's equation n = A + B/λ². Liquids have precedence {LIQUID_PRECEDENCE}, and what is \
         solid has {SOLID_PRECEDENCE}.

| file | A | B (µm²) | n at 589 nm | what it is, and who measured it |
|---|---|---|---|---|
"
    );
    for row in rows(DIELECTRICS) {
        let _ = writeln!(text, "| {}.igs | {} | {} | {} | {} |", row[0], row[1], row[2], row[3], row[4]);
    }
    text
}

/// The rows of a table after its remarks and its head.
fn rows(table: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    table.lines().filter(|l| !l.starts_with('#')).skip(1).map(|l| l.split(',').collect())
}

fn liquid(row: &[&str]) -> (String, String) {
    let name = identifier(row[0]);
    let triple = |at: usize| {
        let [r, g, b] = [row[at], row[at + 1], row[at + 2]];
        format!("<rgb><rgb>{r} {g} {b}</rgb><gamma>1</gamma></rgb>")
    };
    let basic = format!(
        "            <ior>{LIQUID_IOR}</ior>
            <absorption_coefficient_spectrum>{}</absorption_coefficient_spectrum>
            <subsurface_scattering>
                <scattering_coefficient_spectrum>{}</scattering_coefficient_spectrum>
                <phase_function>
                    <henyey_greenstein><g_spectrum>{}</g_spectrum></henyey_greenstein>
                </phase_function>
            </subsurface_scattering>
",
        triple(1),
        triple(4),
        triple(7)
    );
    let text = medium(&name, LIQUID_PRECEDENCE, &format!("{}: {LIQUID_SOURCE}", row[0]), &basic);
    (name, text)
}

fn dielectric(row: &[&str]) -> (String, String) {
    let [name, a, b, what] = [row[0], row[1], row[2], row[4]];
    let is_liquid = ["water", "ethanol"].contains(&name);
    let precedence = if is_liquid { LIQUID_PRECEDENCE } else { SOLID_PRECEDENCE };
    let basic = format!("            <ior>{a}</ior>\n            <cauchy_b_coeff>{b}</cauchy_b_coeff>\n");
    (name.to_owned(), medium(name, precedence, what, &basic))
}

fn medium(name: &str, precedence: u32, remark: &str, basic: &str) -> String {
    let mut text = String::new();
    let _ = write!(
        text,
        "    <!-- {} -->
    <medium>
        <name>{name}</name>
        <precedence>{precedence}</precedence>
        <basic>
{basic}        </basic>
    </medium>
",
        remark.replace('&', "and")
    );
    text
}

/// A name as a file and a scene can carry it: "Milk (lowfat)" is `milk_lowfat`.
fn identifier(name: &str) -> String {
    let kept = name.to_lowercase().replace('&', "and");
    let words = kept.split(|c: char| !c.is_ascii_alphanumeric()).filter(|w| !w.is_empty());
    words.collect::<Vec<_>>().join("_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_a_file_of_its_own() {
        let files = files();
        let mut names: Vec<&str> = files.iter().map(|(path, _)| path.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), 56);
        let (_, list) = files.last().expect("a list");
        let of_media = names.iter().filter_map(|path| path.strip_prefix("media/")?.strip_suffix(".igs"));
        assert_eq!(of_media.filter(|name| list.contains(&format!("| {name}.igs |"))).count(), 55);
        assert_eq!(identifier("Mission Bay 10ft Deep (30 min)"), "mission_bay_10ft_deep_30_min");
        let (_, milk) = files.iter().find(|(path, _)| path == "media/milk_regular.igs").expect("milk");
        assert!(milk.contains("18205.267 20382.6 22369.8"), "{milk}");
    }

    /// Cauchy's A is the index at infinite wavelength, which tables like to mix up with that at the sodium line.
    #[test]
    fn dielectrics_have_their_index_at_the_sodium_line() {
        for row in rows(DIELECTRICS) {
            let [a, b, n_d] = [1, 2, 3].map(|at| row[at].parse::<f64>().expect("a number"));
            assert!((a + b / (0.5893 * 0.5893) - n_d).abs() < 1e-3, "{row:?}");
        }
    }
}
