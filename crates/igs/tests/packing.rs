//! Packed scenes: what is written comes back, and what could do harm is refused.

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_igs::pack::{MaterialPacks, Pack, PackError, PackLimits, PackResolver, PackWriter};
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// An archive of members with their names as they are.
fn archive(members: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    for (name, content) in members {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn open(bytes: Vec<u8>) -> Result<Pack, PackError> {
    Pack::open(bytes.into(), &PackLimits::default())
}

/// What is wrong with an archive.
fn refusal(bytes: Vec<u8>) -> String {
    match open(bytes) {
        Ok(pack) => pack.main().expect_err("something is wrong").to_string(),
        Err(error) => error.to_string(),
    }
}

fn pack() -> Vec<u8> {
    let mut out = Cursor::new(vec![]);
    let mut pack = PackWriter::new(&mut out);
    assert_eq!(pack.add("maps/wood.jpg", b"wood").unwrap(), "PACKED_0_wood.jpg");
    assert_eq!(pack.add("C:\\maps\\Stein boden.jpg", b"stone").unwrap(), "PACKED_1_Stein_boden.jpg");
    assert_eq!(pack.add("other/wood (copy).jpg", b"wood").unwrap(), "PACKED_0_wood.jpg", "stored once");
    assert_eq!(pack.add("wood.nk", b"wood").unwrap(), "PACKED_2_wood.nk", "another kind of file");
    assert_eq!(pack.finish("dir/room.igs", b"<scene/>").unwrap(), 3);
    out.into_inner()
}

#[test]
fn what_is_packed_comes_back() {
    let bytes = pack();
    assert_eq!(bytes, pack(), "always the same bytes");
    let pack = open(bytes).unwrap();
    let members: Vec<_> = pack.members().collect();
    let expected =
        [("PACKED_0_wood.jpg", 4), ("PACKED_1_Stein_boden.jpg", 5), ("PACKED_2_wood.nk", 4), ("room.igs", 8)];
    assert_eq!(members, expected);
    assert_eq!(pack.main().unwrap(), "room.igs");
    let mut archive = zip::ZipArchive::new(Cursor::new(self::pack())).unwrap();
    for i in 0..archive.len() {
        let member = archive.by_index_raw(i).unwrap();
        assert_eq!(member.last_modified(), Some(zip::DateTime::default()));
        assert_eq!(member.unix_mode(), Some(0o100_644), "as on Unix everywhere");
    }
    assert_eq!(pack.read("PACKED_1_Stein_boden.jpg").unwrap(), b"stone");
    assert!(pack.read("nothing").is_err());
}

#[test]
fn names_that_lead_elsewhere_are_refused() {
    for name in [
        "../up.png",
        "a/../../up.png",
        "/etc/passwd",
        "C:/x.png",
        "..\\up.png",
        "\\\\host\\x.png",
        "a//b.png",
        "./a.png",
        "tab\t.png",
        "what?.png",
        "dot.",
        "CON",
        "maps/nul.png",
        "Com1.igs",
        "..",
    ] {
        let text = refusal(archive(&[("scene.igs", b"<scene/>"), (name, b"x")]));
        assert!(text.contains("is refused"), "{name}: {text}");
    }
    for name in ["x".repeat(256), "a/".repeat(513) + "b"] {
        assert!(
            refusal(archive(&[("scene.igs", b"<scene/>"), (&name, b"x")]))
                .contains("not every system allows")
        );
    }
    let both = archive(&[("scene.igs", b"<scene/>"), ("A", b"x"), ("a/b/c.png", b"y")]);
    assert!(refusal(both).contains("\"a/b/c.png\" lies in a folder that is a file, too"));
    let twice = archive(&[("scene.igs", b"<scene/>"), ("a.png", b"x"), ("A.png", b"y")]);
    assert!(refusal(twice).contains("capital letters"));
}

#[test]
fn folders_as_windows_writes_them() {
    let pack = open(archive(&[("room.igs", b"<scene/>"), ("maps\\", b""), ("maps\\wood.png", b"wood")]));
    let pack = pack.unwrap();
    assert_eq!(pack.main().unwrap(), "room.igs");
    assert_eq!(pack.read("maps/wood.png").unwrap(), b"wood");
    assert_eq!(pack.members().count(), 2);
    let twice = archive(&[("scene.igs", b"<scene/>"), ("maps/a.png", b"x"), ("maps\\a.png", b"y")]);
    assert!(refusal(twice).contains("slashes"));
}

#[test]
fn links_are_refused() {
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    zip.add_symlink("link.png", "/etc/passwd", SimpleFileOptions::default()).unwrap();
    let text = refusal(zip.finish().unwrap().into_inner());
    assert!(text.contains("\"link.png\" is a link"), "{text}");
}

#[test]
fn what_is_no_archive_or_a_damaged_one_is_refused() {
    for bytes in [vec![], b"<scene/>".to_vec(), pack()[..100].to_vec()] {
        assert!(refusal(bytes).contains("not a sound packed scene"));
    }
    let mut damaged = archive(&[("scene.igs", b"<scene/>"), ("a.nk", b"0123456789")]);
    let at = damaged.windows(4).position(|w| w == b"a.nk").unwrap() + 6;
    damaged[at] ^= 1;
    let read = open(damaged).and_then(|pack| pack.read("a.nk"));
    assert!(matches!(&read, Err(PackError::Damaged(_))), "{read:?}");
}

#[test]
fn there_must_be_one_scene() {
    assert!(refusal(archive(&[("a.png", b"x")])).ends_with("this one holds none"));
    let two = archive(&[("a.igs", b"<scene/>"), ("b.igs", b"<scene/>")]);
    assert!(refusal(two).ends_with("this one holds a.igs, b.igs"));
    // What the scene includes is no scene of its own.
    let one = archive(&[("PACKED_0_b.igs", b"<scene/>"), ("dir/c.igs", b"<scene/>"), ("a.IGS", b"<scene/>")]);
    assert_eq!(open(one).unwrap().main().unwrap(), "a.IGS");
}

#[test]
fn archives_that_would_become_too_large_are_refused() {
    let limits = PackLimits { always_allowed: 1000, growth: 10, ..PackLimits::default() };
    let zeros = vec![0_u8; 1 << 20];
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    let deflated = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    zip.start_file("scene.igs", deflated).unwrap();
    zip.write_all(&zeros).unwrap();
    let bomb = zip.finish().unwrap().into_inner();
    assert!(bomb.len() < 5000);
    let open = |bytes: &[u8], limits: &PackLimits| Pack::open(bytes.into(), limits).map(|_| ());
    assert!(matches!(open(&bomb, &limits), Err(PackError::TooLarge(_))));
    assert_eq!(open(&bomb, &PackLimits::default()), Ok(()), "a megabyte is nothing");
    let few = PackLimits { members: 1, ..limits };
    let two = archive(&[("scene.igs", b"x"), ("b", b"x")]);
    assert!(matches!(open(&two, &few), Err(PackError::TooLarge(_))));
    let small = PackLimits { member_bytes: 3, ..limits };
    assert!(matches!(open(&archive(&[("scene.igs", b"<scene/>")]), &small), Err(PackError::TooLarge(_))));
}

/// An archive whose members share their bytes can become the square of what it is.
#[test]
fn members_that_share_their_bytes_are_refused() {
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    zip.start_file("scene.igs", SimpleFileOptions::default()).unwrap();
    zip.write_all(b"<scene/>").unwrap();
    zip.shallow_copy_file("scene.igs", "copy.igs").unwrap();
    assert!(refusal(zip.finish().unwrap().into_inner()).contains("share their bytes"));
}

/// A size in the list of members that is not true is found when the member is read, before memory is asked for.
#[test]
fn sizes_that_are_not_true_are_found() {
    let mut bytes = archive(&[("scene.igs", &[b' '; 100])]);
    // The size, behind the checksum and the compressed size, in the list of members (APPNOTE 4.3.12).
    let list = bytes.windows(4).rposition(|w| w == b"PK\x01\x02").unwrap();
    bytes[list + 24..list + 28].copy_from_slice(&200_000_000_u32.to_le_bytes());
    let read = open(bytes).and_then(|pack| pack.read("scene.igs"));
    assert!(matches!(&read, Err(PackError::Damaged(_))), "{read:?}");
}

/// A place whose files say where they are from.
struct Place(&'static str);

impl Resolver for Place {
    fn read(&self, path: &str, _: &str) -> Result<Resolved, ResolveError> {
        let known = ["inifile.xml", "nkdata/au.nk", "PACKED_0_a.png", "etc/passwd", "passwd"];
        if known.contains(&path) {
            Ok(Resolved { path: path.to_owned(), bytes: self.0.as_bytes().into() })
        } else {
            Err(ResolveError::NotFound { looked: vec![path.to_owned()] })
        }
    }
}

#[test]
fn a_packed_scene_is_read_as_it_lies() {
    let bytes = archive(&[
        ("scene.igs", b"<scene/>"),
        ("PACKED_0_a.png", b"a"),
        ("parts/b.igs", b"<scenedata/>"),
        ("parts/c.png", b"c"),
    ]);
    let (outside, resources) = (Place("outside"), Place("resources"));
    let limits = PackLimits::default();
    let resolver = PackResolver::open("x/s.pigs", bytes.into(), &limits, &outside, &resources).unwrap();
    let scene = resolver.read("x/s.pigs", "").unwrap();
    assert_eq!((&*scene.path, &*scene.bytes), ("x/s.pigs/scene.igs", b"<scene/>".as_slice()));
    let read = |path: &str, from: &str| resolver.read(path, from).map(|found| found.bytes.to_vec());
    let from_scene = |path: &str| read(path, "x/s.pigs/scene.igs");
    assert_eq!(from_scene("PACKED_0_a.png").unwrap(), b"a");
    assert_eq!(from_scene("packed_0_A.PNG").unwrap(), b"a");
    assert_eq!(from_scene("parts\\c.png").unwrap(), b"c");
    assert_eq!(from_scene("D:\\work\\PACKED_0_a.png").unwrap(), b"a");
    assert_eq!(read("c.png", "x/s.pigs/parts/b.igs").unwrap(), b"c");
    assert_eq!(read("../PACKED_0_a.png", "x/s.pigs/parts/b.igs").unwrap(), b"a");
    // What comes with the program, and what that names; and what the program itself asks for.
    assert_eq!(read("nkdata/au.nk", "nkdata/list.igs").unwrap(), b"resources");
    assert_eq!(from_scene("nkdata/au.nk").unwrap(), b"resources");
    assert_eq!(read("inifile.xml", "").unwrap(), b"outside");
    // Nothing else of the disk.
    for path in ["/etc/passwd", "../../etc/passwd", "C:/passwd", "inifile.xml/../../passwd"] {
        let read = from_scene(path);
        assert!(matches!(read, Err(ResolveError::NotFound { .. })), "{path}: {read:?}");
    }
}

/// A disk with one packed material, and a file beside it.
struct Shelf(Vec<u8>);

impl Resolver for Shelf {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        let bytes = match path {
            "lib/wall.PIGM" => self.0.clone(),
            "gold.nk" => b"outside".to_vec(),
            _ => return Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        };
        Ok(Resolved { path: path.to_owned(), bytes: bytes.into() })
    }
}

#[test]
fn a_packed_material_stands_for_the_material_in_it() {
    let packed = archive(&[("wall.igm", b"<scenedata/>"), ("PACKED_0_PACKED_0_brick.jpg", b"brick")]);
    let shelf = Shelf(packed);
    let packs = MaterialPacks::new(&shelf, PackLimits::default());
    let material = packs.read("lib/wall.PIGM", "room.igs").unwrap();
    assert_eq!((&*material.path, &*material.bytes), ("lib/wall.PIGM/wall.igm", &b"<scenedata/>"[..]));
    // What it names is in the pack, whatever folder it was in; and what is not, where the pack is.
    let brick = packs.read("maps\\packed_0_PACKED_0_brick.jpg", &material.path).unwrap();
    assert_eq!(&*brick.bytes, b"brick");
    assert_eq!(&*packs.read("gold.nk", &material.path).unwrap().bytes, b"outside");
    assert!(packs.read("PACKED_0_PACKED_0_brick.jpg", "room.igs").is_err(), "not from elsewhere");
    for bad in
        [b"no archive".to_vec(), archive(&[("a.txt", b"")]), archive(&[("a.igm", b""), ("b.igm", b"")])]
    {
        let shelf = Shelf(bad);
        let read = MaterialPacks::new(&shelf, PackLimits::default()).read("lib/wall.PIGM", "room.igs");
        assert!(matches!(read, Err(ResolveError::Unreadable { .. })));
    }
}
