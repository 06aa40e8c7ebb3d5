//! Packing scenes, rendering them as they are, and unpacking them.

use super::workbench::Workbench;
use std::io::Write as _;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const QUIET: &str = "<logging>false</logging>";
const CHECKER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../testscenes/textures/checker.png");

/// A scene of several files: an included one that has a texture and a metal, and the texture once more by another name.
fn bench() -> Workbench {
    let bench = Workbench::new(&format!("{QUIET}<save_igi>true</save_igi>"));
    let texture = "<diffuse><albedo_texture><uv_set>uv</uv_set><path>NAME</path></albedo_texture></diffuse>";
    std::fs::create_dir_all(bench.path("maps & more")).expect("a folder");
    std::fs::create_dir_all(bench.path("parts")).expect("a folder");
    for copy in ["maps & more/wood.png", "parts/copy.png"] {
        std::fs::copy(CHECKER, bench.path(copy)).expect("a test scene's texture");
    }
    bench.write(
        "parts/metals.igs",
        "<!-- metals --><scenedata><material><name>gold</name><phong><nk_data>nkdata/au.nk</nk_data>\
         <exponent>50</exponent></phong></material>\n<material><name>same</name>\
         <diffuse><albedo_texture><uv_set>uv</uv_set><path><![CDATA[copy.png]]></path></albedo_texture></diffuse>\
         </material></scenedata>",
    );
    let scene = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let more = format!(
        "<!-- who -->\n<include><pathname>parts\\metals.igs</pathname></include>\
         <material><name>wood</name>{}</material>\
         <mesh><name>card</name><embedded><expose_uv_set><index>0</index><name>uv</name></expose_uv_set>\
         <vertex pos=\"-2 3 -1\" normal=\"0 -1 0\" uv0=\"0 0\"/><vertex pos=\"-1 3 -1\" normal=\"0 -1 0\" uv0=\"1 0\"/>\
         <vertex pos=\"-1 3 1\" normal=\"0 -1 0\" uv0=\"1 1\"/>\
         <triangle_set><material_name>wood</material_name><tri>0 1 2</tri></triangle_set></embedded></mesh>\
         <model><pos>0 0 0</pos><scale>1</scale><mesh_name>card</mesh_name></model>\
         <sphere><center>1.5 4 0</center><radius>0.5</radius><material_name>gold</material_name></sphere>\n</scene>",
        texture.replace("NAME", " maps &amp; more/wood.png ")
    );
    bench.write("scene.igs", &scene.replace("</scene>", &more));
    bench
}

#[test]
fn a_packed_scene_is_the_same_scene() {
    let bench = bench();
    let ran = bench.run(&["--pack", "scene.igs", "out.pigs"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(ran.stderr.contains("Saved out.pigs: the scene and 3 files"), "{}", ran.stderr);
    assert_eq!(bench.run(&["--pack", "scene.igs", "again.pigs"]).status, Some(0));
    let bytes = |name: &str| std::fs::read(bench.path(name)).expect("a file");
    assert_eq!(bytes("out.pigs"), bytes("again.pigs"), "always the same bytes");
    // In another folder, where none of the files is.
    std::fs::create_dir(bench.path("elsewhere")).expect("a folder");
    std::fs::rename(bench.path("out.pigs"), bench.path("elsewhere/out.pigs")).expect("a move");
    let packed = bench.run(&["elsewhere/out.pigs", "-haltspp", "4", "-t", "1", "-o", "packed.png"]);
    assert_eq!(packed.status, Some(0), "{packed:?}");
    let plain = bench.run(&["scene.igs", "-haltspp", "4", "-t", "1", "-o", "plain.png"]);
    assert_eq!(plain.status, Some(0), "{plain:?}");
    let pixels = |name: &str| indigo_formats::image::decode(name, &bytes(name)).expect("a picture").pixels;
    assert_eq!(pixels("packed.png"), pixels("plain.png"));
    // A film of the one goes on with the other.
    let on = bench.run(&["elsewhere/out.pigs", "-r", "plain.igi", "-haltspp", "8", "-o", "on.png"]);
    assert_eq!(on.status, Some(0), "{on:?}");
    assert!(on.stderr.contains("Going on with"), "{}", on.stderr);
}

#[test]
fn an_unpacked_scene_renders_and_keeps_its_text() {
    let bench = bench();
    assert_eq!(bench.run(&["--pack", "scene.igs", "out.pigs"]).status, Some(0));
    let ran = bench.run(&["--unpack", "out.pigs", "there/new"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    let mut names: Vec<String> = std::fs::read_dir(bench.path("there/new"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, ["PACKED_0_au.nk", "PACKED_1_copy.png", "PACKED_2_metals.igs", "scene.igs"]);
    let text = |name: &str| std::fs::read_to_string(bench.path(name)).expect("a text");
    let rewritten = text("there/new/scene.igs")
        .replace("PACKED_2_metals.igs", "parts\\metals.igs")
        .replace("PACKED_1_copy.png", "maps &amp; more/wood.png");
    assert_eq!(rewritten, text("scene.igs"), "nothing but the paths is another");
    assert!(text("there/new/PACKED_2_metals.igs").contains("<path><![CDATA[PACKED_1_copy.png]]></path>"));
    let check = bench.run(&["there/new/scene.igs", "--check"]);
    assert_eq!(check.status, Some(0), "{check:?}");
    // A folder with something in it is left alone.
    let again = bench.run(&["--unpack", "out.pigs", "there/new"]);
    assert_eq!(again.status, Some(2), "{again:?}");
    assert!(again.stderr.contains("is not empty"), "{}", again.stderr);
    // What a killed one has left is told, with what to do.
    std::fs::create_dir(bench.path("more.unpacking")).expect("a folder");
    let blocked = bench.run(&["--unpack", "out.pigs", "more"]);
    assert_eq!(blocked.status, Some(1), "{blocked:?}");
    assert!(blocked.stderr.contains("more.unpacking is there") && blocked.stderr.contains("remove it"));
    let nameless = bench.run(&["--unpack", "out.pigs", ""]);
    assert_eq!(nameless.status, Some(2), "{nameless:?}");
    assert!(nameless.stderr.contains("the name of the folder to make is empty"), "{nameless:?}");
}

#[test]
fn what_cannot_be_packed_is_named() {
    let bench = bench();
    // Nothing uses the material that names it.
    std::fs::remove_file(bench.path("parts/copy.png")).expect("a file");
    let ran = bench.run(&["--pack", "scene.igs", "out.pigs"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(ran.stderr.contains("metals.igs:2:") && ran.stderr.contains("W0316"), "{}", ran.stderr);
    assert_eq!(bench.run(&["out.pigs", "-haltspp", "1", "-o", "a.png"]).status, Some(0));
    std::fs::remove_file(bench.path("maps & more/wood.png")).expect("a file");
    let ran = bench.run(&["--pack", "scene.igs", "none.pigs"]);
    assert_eq!(ran.status, Some(2), "{ran:?}");
    assert!(
        ran.stderr.contains("scene.igs:14:") && ran.stderr.contains("cannot read maps"),
        "{}",
        ran.stderr
    );
    assert!(!bench.path("none.pigs").exists());
    let wrong = bench.run(&["--pack", "scene.igs", "out.zip"]);
    assert_eq!(wrong.status, Some(2), "{wrong:?}");
    assert!(wrong.stderr.contains("ends in .pigs"), "{}", wrong.stderr);
    let one = bench.run(&["--pack", "scene.igs"]);
    assert!(one.status == Some(2) && one.stderr.contains("--pack SCENE.igs OUT.pigs"), "{one:?}");
}

/// A path in pieces, of which another could not take the place without breaking the file.
#[test]
fn paths_that_cannot_be_rewritten_are_named() {
    let bench = bench();
    let scene = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    for odd in [
        "maps & more/<![CDATA[wood]]>.<![CDATA[png]]>",
        "<![CDATA[maps & more]]>/<![CDATA[wood]]>.png",
        "<![CDATA[maps & more/wood]]>.png",
    ] {
        bench.write(
            "odd.igs",
            &scene.replace(" maps &amp; more/wood.png ", &odd.replace("maps & more/<", "maps &amp; more/<")),
        );
        let ran = bench.run(&["--pack", "odd.igs", "odd.pigs"]);
        assert!(ran.status == Some(2) && ran.stderr.contains("E0313"), "{odd}: {ran:?}");
        assert!(!bench.path("odd.pigs").exists());
    }
    let whole = "<![CDATA[maps & ]]>more/<![CDATA[wood.png]]>";
    bench.write("whole.igs", &scene.replace(" maps &amp; more/wood.png ", whole));
    assert_eq!(bench.run(&["--pack", "whole.igs", "whole.pigs"]).status, Some(0));
    assert_eq!(bench.run(&["whole.pigs", "--check"]).status, Some(0));
}

#[test]
fn what_is_wrong_in_a_packed_scene_has_its_place_there() {
    let bench = bench();
    bench.write("bad.pigs", "<scene/>");
    let ran = bench.run(&["bad.pigs"]);
    assert_eq!(ran.status, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("bad.pigs: this is not a sound packed scene"), "{}", ran.stderr);
    let unpacked = bench.run(&["--unpack", "bad.pigs", "there"]);
    assert!(unpacked.status == Some(2) && !bench.path("there").exists(), "{unpacked:?}");
    let out = std::fs::File::create(bench.path("out.pigs")).expect("a file");
    let mut pack = indigo_igs::pack::PackWriter::new(out);
    let metals = "<scenedata>\n<material><nme>x</nme></material></scenedata>";
    pack.add("metals.igs", metals.as_bytes()).expect("a disk");
    let scene = "<scene><include><pathname>PACKED_0_metals.igs</pathname></include></scene>";
    pack.finish("scene.igs", scene.as_bytes()).expect("a disk");
    let ran = bench.run(&["out.pigs", "--check"]);
    assert_eq!(ran.status, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("out.pigs/PACKED_0_metals.igs:2:"), "{}", ran.stderr);
}

/// A mesh called as its file is: the name stays, the path does not.
#[test]
fn a_name_that_is_also_a_path_is_but_a_name() {
    let bench = bench();
    let scene = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let name = "maps &amp; more/wood.png";
    bench.write(
        "scene.igs",
        &scene
            .replace("<name>wood</name>", &format!("<name>{name}</name>"))
            .replace("<material_name>wood", &format!("<material_name>{name}")),
    );
    assert_eq!(bench.run(&["--pack", "scene.igs", "out.pigs"]).status, Some(0));
    assert_eq!(bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]).status, Some(0));
    let on = bench.run(&["out.pigs", "-r", "a.igi", "-haltspp", "2", "-o", "b.png"]);
    assert_eq!(on.status, Some(0), "{on:?}");
}

/// In the same folder, and in another one, from where the files are found all the same.
#[test]
fn a_scene_written_anew_renders_the_same() {
    let bench = bench();
    std::fs::create_dir(bench.path("new")).expect("a folder");
    let plain = bench.run(&["scene.igs", "-haltspp", "4", "-t", "1", "-o", "plain.png"]);
    assert_eq!(plain.status, Some(0), "{plain:?}");
    let pixels = |name: &str| {
        let bytes = std::fs::read(bench.path(name)).expect("a file");
        indigo_formats::image::decode(name, &bytes).expect("a picture").pixels
    };
    for (anew, picture) in [("anew.igs", "anew.png"), ("new/anew.igs", "new/anew.png")] {
        let written = bench.run(&["--upgrade", "scene.igs", anew]);
        assert_eq!(written.status, Some(0), "{written:?}");
        let text = std::fs::read_to_string(bench.path(anew)).expect("the scene");
        assert!(
            text.contains("<!-- ") && text.contains("<material>") && !text.contains("<include>"),
            "{text}"
        );
        let ran = bench.run(&[anew, "-haltspp", "4", "-t", "1", "-o", picture]);
        assert_eq!(ran.status, Some(0), "{ran:?}\n{text}");
        assert!(!ran.stderr.contains("warning"), "{ran:?}");
        assert_eq!(pixels(picture), pixels("plain.png"), "{text}");
    }
    let text = std::fs::read_to_string(bench.path("anew.igs")).expect("the scene");
    assert!(text.contains("<path>parts/copy.png</path>") && text.contains("nkdata/au.nk"), "{text}");
    // Written anew once more it stays as it is, but for its title.
    assert_eq!(bench.run(&["--upgrade", "anew.igs", "again.igs"]).status, Some(0));
    let body = |name: &str| {
        let text = std::fs::read_to_string(bench.path(name)).expect("the scene");
        text.lines().skip(2).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(body("again.igs"), body("anew.igs"));
    // What lies beside the scene comes before what lies beside the file that names it.
    std::fs::copy(CHECKER, bench.path("copy.png")).expect("a test scene's texture");
    assert_eq!(bench.run(&["--upgrade", "scene.igs", "other.igs"]).status, Some(0));
    let text = std::fs::read_to_string(bench.path("other.igs")).expect("the scene");
    assert!(text.contains("<path>copy.png</path>"), "{text}");
    // No file that was read is written over.
    for read in ["scene.igs", "parts/metals.igs"] {
        let before = std::fs::read(bench.path(read)).expect("the scene");
        let ran = bench.run(&["--upgrade", "scene.igs", read]);
        assert!(ran.status == Some(2) && ran.stderr.contains("overwritten"), "{ran:?}");
        assert_eq!(std::fs::read(bench.path(read)).expect("the scene"), before);
    }
    // What is wrong is told, and nothing is written.
    bench.write("bad.igs", "<scene><sphere><radius>-1</radius></sphere></scene>");
    let bad = bench.run(&["--upgrade", "bad.igs", "good.igs"]);
    assert!(bad.status == Some(2) && bad.stderr.contains("bad.igs:1:"), "{bad:?}");
    assert!(!bench.path("good.igs").exists());
}

/// A packed material of a name whose texture is called `tile.png` in each.
fn write_packed_material(bench: &Workbench, path: &str, name: &str, texture: &[u8]) {
    let material = format!(
        "<scenedata><material><name>{name}</name><diffuse><albedo_texture><uv_set>uv</uv_set>\
         <path>c:\\maps\\tile.png</path></albedo_texture></diffuse></material></scenedata>"
    );
    let mut zip = ZipWriter::new(std::fs::File::create(bench.path(path)).expect("a file"));
    for (member, content) in [("tile.igm", material.as_bytes()), ("tile.png", texture)] {
        zip.start_file(member, SimpleFileOptions::default()).expect("a member");
        zip.write_all(content).expect("its content");
    }
    zip.finish().expect("an archive");
}

/// Their files come to lie beside it, two of one name, too; what else is there stays.
#[test]
fn packed_scenes_and_materials_are_written_anew_with_their_files() {
    let bench = bench();
    let checker = std::fs::read(CHECKER).expect("a test scene's texture");
    let other = std::fs::read(CHECKER.replace("checker.png", "tiles.png")).expect("a test scene's texture");
    write_packed_material(&bench, "a.pigm", "tile a", &checker);
    write_packed_material(&bench, "b.pigm", "tile b", &other);
    let scene = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let includes = "<include><pathname>a.pigm</pathname></include><include><pathname>b.pigm</pathname></include><include>";
    let scene = scene.replacen("<include>", includes, 1);
    bench.write("scene.igs", &scene.replace("<material_name>wood<", "<material_name>tile b<"));
    assert_eq!(bench.run(&["--pack", "scene.igs", "out.pigs"]).status, Some(0));
    std::fs::create_dir(bench.path("new")).expect("a folder");
    let pixels = |scene: &str| {
        let ran = bench.run(&[scene, "-haltspp", "4", "-t", "1", "-o", "picture.png"]);
        assert_eq!(ran.status, Some(0), "{ran:?}");
        let bytes = std::fs::read(bench.path("picture.png")).expect("a file");
        indigo_formats::image::decode("picture.png", &bytes).expect("a picture").pixels
    };
    let expected = pixels("scene.igs");
    // The pack holds the metal, too, and of pictures that are alike one.
    for (old, files) in [("scene.igs", 2), ("out.pigs", 3)] {
        let ran = bench.run(&["--upgrade", old, "new/anew.igs"]);
        assert_eq!(ran.status, Some(0), "{ran:?}");
        let told = format!("Saved new/anew.igs, and {files} files of packed ones in new/anew_files");
        assert!(ran.stderr.contains(&told), "{}", ran.stderr);
        let found = std::fs::read_dir(bench.path("new/anew_files")).expect("a folder").count();
        assert_eq!(found, files);
        assert_eq!(pixels("new/anew.igs"), expected, "{old}");
        // The same files once more are no reason to refuse, others are.
        assert_eq!(bench.run(&["--upgrade", old, "new/anew.igs"]).status, Some(0));
        let name = std::fs::read_dir(bench.path("new/anew_files")).expect("a folder").next();
        let file = name.expect("a file").expect("a file").path();
        std::fs::write(&file, "mine").expect("a file");
        let ran = bench.run(&["--upgrade", old, "new/anew.igs"]);
        assert!(ran.status == Some(2) && ran.stderr.contains("is there already"), "{ran:?}");
        assert_eq!(std::fs::read(&file).expect("a file"), b"mine");
        std::fs::remove_dir_all(bench.path("new/anew_files")).expect("a folder");
    }
}

/// If it is asked for, a scene is packed and written anew without the textures that are missing, which it names all the same.
#[test]
fn placeholders_let_scenes_with_missing_files_be_written() {
    let bench = bench();
    std::fs::remove_file(bench.path("maps & more/wood.png")).expect("a file");
    for (task, out) in [("--pack", "out.pigs"), ("--upgrade", "anew.igs")] {
        let ran = bench.run(&[task, "scene.igs", out]);
        assert_eq!(ran.status, Some(2), "{ran:?}");
        assert!(ran.stderr.contains("E0302") && !bench.path(out).exists(), "{}", ran.stderr);
        let ran = bench.run(&[task, "scene.igs", out, "-placeholders"]);
        assert_eq!(ran.status, Some(0), "{ran:?}");
        let warnings: Vec<&str> = ran.stderr.lines().filter(|line| line.contains("warning[")).collect();
        assert!(warnings.len() == 1 && warnings[0].contains("wood.png"), "{}", ran.stderr);
        // Read again it is the scene that it was, whether or not something stands in.
        let render = [out, "-haltspp", "1", "-o", "a.png"];
        let refused = bench.run(&render);
        assert!(refused.status == Some(2) && refused.stderr.contains("E0302"), "{refused:?}");
        let stood_in = bench.run(&[&render[..], &["-placeholders"]].concat());
        assert_eq!(stood_in.status, Some(0), "{stood_in:?}");
    }
    let text = std::fs::read_to_string(bench.path("anew.igs")).expect("the scene");
    assert!(text.contains("<path>maps &amp; more/wood.png</path>"), "{text}");
    assert!(!text.contains("placeholders"), "{text}");
    // It finds the file where the other scene does, once that is there again.
    std::fs::copy(CHECKER, bench.path("maps & more/wood.png")).expect("a test scene's texture");
    assert_eq!(bench.run(&["anew.igs", "--check"]).status, Some(0));
}

#[test]
fn all_files_of_a_scene_are_listed_and_what_is_missing_is_told() {
    let bench = bench();
    let ran = bench.run(&["--list-files", "scene.igs"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert_eq!(ran.stdout.lines().count(), 5, "{}", ran.stdout);
    let size = std::fs::metadata(CHECKER).expect("a test scene's texture").len();
    for end in ["wood.png", "copy.png"] {
        let line = ran.stdout.lines().find(|line| line.ends_with(end)).expect("a texture");
        assert!(line.trim_start().starts_with(&format!("{size} ")), "{line}");
    }
    for end in ["scene.igs", "metals.igs", "au.nk"] {
        assert!(ran.stdout.lines().any(|line| line.ends_with(end)), "{end}: {}", ran.stdout);
    }
    std::fs::remove_file(bench.path("parts/copy.png")).expect("a texture");
    let ran = bench.run(&["--list-files", "scene.igs"]);
    assert_eq!(ran.status, Some(2), "{ran:?}");
    let line = ran.stdout.lines().find(|line| line.contains("missing")).expect("what is missing");
    assert!(line.contains("copy.png, named in") && line.contains("metals.igs:2:"), "{line}");
    assert!(ran.stderr.contains("1 file missing"), "{}", ran.stderr);
    let ran = bench.run(&["--list-files", "--json", "scene.igs"]);
    assert_eq!(ran.stdout.lines().filter(|line| line.contains("\"bytes\":")).count(), 4, "{}", ran.stdout);
    assert_eq!(ran.stdout.lines().filter(|line| line.contains("\"missing\":")).count(), 1, "{}", ran.stdout);
}
