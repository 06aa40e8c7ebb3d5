//! The measured metals that come with the program are what their list says.

use indigo_formats::nk;
use std::path::Path;

fn is_metal(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension == "nk")
}

/// Reflectance along the normal.
fn along_the_normal([n, k]: [f64; 2]) -> f64 {
    ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k)
}

#[test]
fn every_metal_covers_what_is_visible_and_reflects_as_its_list_says() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../nkdata");
    let list = std::fs::read_to_string(folder.join("README.md")).expect("the list");
    let rows = list.lines().filter_map(|line| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        cells.get(1).is_some_and(|name| is_metal(name)).then(|| (cells[1].to_owned(), cells[3].to_owned()))
    });
    let mut listed: Vec<String> = vec![];
    for (name, stated) in rows {
        let index = nk::read(&std::fs::read(folder.join(&name)).expect("a listed file")).expect("sound data");
        let [first, last] = index.range_nm();
        // Two end at 820 nm; beyond, the last value holds, and the eye sees less than 1e-5 of its most.
        assert!(first <= 360.0 + 1e-6 && last >= 820.0 - 1e-6, "{name}: {first} to {last} nm");
        let reflectance = along_the_normal(index.at(550.0));
        let stated: f64 = stated.parse().expect("a reflectance");
        assert!((reflectance - stated).abs() < 6e-4, "{name}: {reflectance} and not {stated}");
        listed.push(name);
    }
    let mut files: Vec<String> = std::fs::read_dir(folder)
        .expect("the folder")
        .map(|file| file.expect("a file").file_name().to_string_lossy().into_owned())
        .filter(|name| is_metal(name))
        .collect();
    files.sort();
    listed.sort();
    assert_eq!(listed, files);
    assert_eq!(files.len(), 23);
}
