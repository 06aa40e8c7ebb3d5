//! The dependency edges between our crates against the table in ARCHITECTURE.md.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::tables::{rows, section};
use super::{ARCHITECTURE, Finding};

/// The table's marker.
const MARKER: &str = "dependencies";
/// The layer of tools, which nothing that is shipped may use.
pub const TOOLS: u32 = 100;

/// One crate as the table has it.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Row {
    line: usize,
    layer: u32,
    uses: BTreeSet<String>,
}

/// The table: crates by their short names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layers {
    rows: BTreeMap<String, Row>,
}

/// The workspace as cargo has it: for each crate what it is built with, and what only its tests use.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    crates: BTreeMap<String, Edges>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Edges {
    normal: BTreeSet<String>,
    development: BTreeSet<String>,
}

/// Crates are written without the project's name: `indigo-math` is `math`.
fn short(name: &str) -> String {
    name.trim_start_matches("indigo-").to_string()
}

impl Layers {
    /// Reads the table `| crate | layer | uses |`, `layer` as `L3` or `dev`.
    pub fn parse(path: &str, document: &str, findings: &mut Vec<Finding>) -> Self {
        let Some(section) = section(document, MARKER) else {
            findings.push(Finding::new(
                path,
                0,
                format!("no table between <!-- {MARKER}:begin --> and :end"),
            ));
            return Self::default();
        };
        let mut layers = Self::default();
        for (line, cells) in rows(&section) {
            match parse_row(line, &cells) {
                Some((name, row)) => {
                    if layers.rows.insert(name.clone(), row).is_some() {
                        findings.push(Finding::new(path, line, format!("`{name}` is listed twice")));
                    }
                }
                None => {
                    findings.push(Finding::new(path, line, "expected | crate | L0 to L9 or dev | uses |"));
                }
            }
        }
        layers
    }

    /// The layer of a crate, by its short name.
    pub fn layer(&self, name: &str) -> Option<u32> {
        self.rows.get(name).map(|row| row.layer)
    }
}

fn parse_row(line: usize, cells: &[String]) -> Option<(String, Row)> {
    let [name, layer, uses, ..] = cells else { return None };
    let layer = if layer == "dev" { TOOLS } else { layer.strip_prefix('L')?.parse().ok()? };
    let uses = uses.split(',').map(|used| short(used.trim()));
    let uses =
        uses.filter(|used| used.starts_with(|c: char| c.is_ascii_alphabetic()) && used != "none").collect();
    (!name.is_empty()).then(|| (short(name), Row { line, layer, uses }))
}

/// Reads the output of `cargo metadata --no-deps --format-version 1`.
pub fn parse_metadata(json: &[u8]) -> Result<Graph, String> {
    let value: Value = serde_json::from_slice(json).map_err(|error| format!("cargo metadata: {error}"))?;
    let list = |value: &Value, key: &str| value[key].as_array().cloned().unwrap_or_default();
    let packages = list(&value, "packages");
    let name_of = |value: &Value| value["name"].as_str().unwrap_or_default().to_string();
    let ours: BTreeSet<String> = packages.iter().map(name_of).collect();
    let mut graph = Graph::default();
    for package in &packages {
        let edges = graph.crates.entry(short(&name_of(package))).or_default();
        for dependency in list(package, "dependencies") {
            let name = name_of(&dependency);
            if !ours.contains(&name) {
                continue;
            }
            let development = dependency["kind"].as_str() == Some("dev");
            let set = if development { &mut edges.development } else { &mut edges.normal };
            set.insert(short(&name));
        }
    }
    Ok(graph)
}

/// What differs between the table and the manifests, and which edges break the rule of layers.
pub fn compare(path: &str, layers: &Layers, graph: &Graph) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (name, row) in &layers.rows {
        if !graph.crates.contains_key(name) {
            findings.push(Finding::new(path, row.line, format!("`{name}` is no crate of the workspace")));
        }
    }
    for (name, edges) in &graph.crates {
        let manifest = format!("crates/{name}/Cargo.toml");
        let Some(row) = layers.rows.get(name) else {
            findings.push(Finding::new(path, 0, format!("`{name}` is not in the table of dependencies")));
            continue;
        };
        let mut note = |what: String| findings.push(Finding::new(&manifest, 0, what));
        for used in edges.normal.difference(&row.uses) {
            note(format!("`{name}` uses `{used}`, an edge that {ARCHITECTURE} does not have"));
        }
        for used in row.uses.difference(&edges.normal) {
            note(format!("`{name}` does not use `{used}`, as {ARCHITECTURE} says"));
        }
        for used in edges.normal.iter().chain(&edges.development) {
            if let Some(rule) = broken_rule(layers, name, row, used, edges.normal.contains(used)) {
                note(rule);
            }
        }
    }
    findings
}

/// Strictly downwards; tests may also use tools that themselves use nothing above.
fn broken_rule(layers: &Layers, name: &str, row: &Row, used: &str, normal: bool) -> Option<String> {
    let below = layers.layer(used)?;
    if below < row.layer || (!normal && below == TOOLS) {
        return None;
    }
    Some(format!("`{name}` may use lower layers only, and `{used}` is not below it"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "<!-- dependencies:begin -->\n\
        | crate | layer | uses |\n|---|---|---|\n\
        | `math` | L0 | none |\n\
        | `geom` | L2 | `math` |\n\
        | `film` | L2 | math |\n\
        | testkit | dev | - |\n\
        <!-- dependencies:end -->\n";

    fn layers() -> Layers {
        let mut findings = Vec::new();
        let layers = Layers::parse("A.md", TABLE, &mut findings);
        assert!(findings.is_empty(), "{findings:?}");
        layers
    }

    /// Metadata of `geom` with these dependencies, and of the other crates of the table as listed.
    fn metadata(geom: &[(&str, Option<&str>)]) -> Vec<u8> {
        let edge = |(name, kind): &(&str, Option<&str>)| serde_json::json!({"name": name, "kind": kind});
        let package =
            |name: &str, edges: Vec<Value>| serde_json::json!({"name": name, "dependencies": edges});
        let film = vec![edge(&("indigo-math", None))];
        serde_json::json!({"packages": [
            package("indigo-math", vec![]),
            package("indigo-geom", geom.iter().map(edge).collect()),
            package("indigo-film", film),
            package("indigo-testkit", vec![]),
        ]})
        .to_string()
        .into_bytes()
    }

    fn findings(geom: &[(&str, Option<&str>)]) -> Vec<String> {
        let graph = parse_metadata(&metadata(geom)).unwrap();
        compare("A.md", &layers(), &graph).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn the_table_is_read() {
        let layers = layers();
        assert_eq!(layers.layer("geom"), Some(2));
        assert_eq!(layers.layer("testkit"), Some(TOOLS));
        assert!(layers.rows["math"].uses.is_empty() && layers.rows["testkit"].uses.is_empty());
    }

    #[test]
    fn listed_edges_and_test_tools_pass() {
        let geom = [("indigo-math", None), ("indigo-testkit", Some("dev")), ("rayon", None)];
        assert_eq!(findings(&geom), Vec::<String>::new());
    }

    #[test]
    fn an_edge_to_a_sibling_is_found_twice_over() {
        let found = findings(&[("indigo-math", None), ("indigo-film", None)]);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].contains("does not have") && found[1].contains("lower layers only"));
    }

    #[test]
    fn a_test_may_not_use_a_sibling_either() {
        let found = findings(&[("indigo-math", None), ("indigo-film", Some("dev"))]);
        assert!(found.len() == 1 && found[0].contains("lower layers only"), "{found:?}");
    }

    #[test]
    fn what_ships_may_not_use_a_tool() {
        let found = findings(&[("indigo-math", None), ("indigo-testkit", None)]);
        assert!(found.iter().any(|text| text.contains("lower layers only")), "{found:?}");
    }

    #[test]
    fn an_edge_that_is_gone_is_found() {
        let found = findings(&[]);
        assert!(found.len() == 1 && found[0].contains("does not use `math`"), "{found:?}");
    }

    #[test]
    fn crates_missing_on_either_side_are_found() {
        let graph = parse_metadata(br#"{"packages": [{"name": "indigo-net", "dependencies": []}]}"#).unwrap();
        let found = compare("A.md", &layers(), &graph);
        assert_eq!(found.len(), 5, "{found:?}");
    }

    #[test]
    fn a_bad_table_is_found_by_line() {
        let mut findings = Vec::new();
        let text = "<!-- dependencies:begin -->\n| math | zero | |\n| a | L1 | |\n| a | L1 | |\n<!-- dependencies:end -->";
        Layers::parse("A.md", text, &mut findings);
        assert_eq!(findings.iter().map(|f| f.line).collect::<Vec<_>>(), [2, 4]);
        Layers::parse("A.md", "", &mut findings);
        assert_eq!(findings.len(), 3);
    }
}
