use super::*;

const HEAD: &str = "IESNA:LM-63-2002\r\n[TEST] 1\r\n[MANUFAC] Nobody\r\nTILT=NONE\r\n";
const BODY: &str = "1 1000 2 3 1 1 2 0.1 0.1 0\n0.9 0.5 60\n0 45, 90\n0\n100 50 0\n";

fn text(head: &str, body: &str) -> Vec<u8> {
    format!("{head}{body}").into_bytes()
}

#[track_caller]
fn refused(bytes: &[u8], message: &str) {
    assert_eq!(decode(bytes).unwrap_err().to_string(), message);
}

#[test]
fn all_editions_are_read_and_factors_multiplied() {
    for head in [
        HEAD,
        "IESNA:LM-63-1995\nTILT=NONE\n",
        "IESNA91\n[MORE] é\nTILT = none\n",
        "A lamp of 1986,\nwith two lines of labels\nTILT=NONE\n",
        "IESNA: LM-63-2002\nTILT=INCLUDE\n1\n2\n0 90\n1 0.8\n",
    ] {
        let lamp = decode(&text(head, BODY)).unwrap();
        assert_eq!(lamp.vertical_deg, [0.0, 45.0, 90.0]);
        assert_eq!(lamp.horizontal_deg, [0.0]);
        assert!(lamp.candela.iter().zip([90.0, 45.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-12));
    }
    // Labels in an old encoding.
    let mut bytes = b"lamp caf\xe9\nTILT=NONE\n".to_vec();
    bytes.extend(BODY.bytes());
    assert!(decode(&bytes).is_ok());
}

/// The number behind the ballast factor is a factor up to 2002, and since 2019 it tells how the file was made.
#[test]
fn the_file_generation_type_is_no_factor() {
    for (head, largest) in [
        ("IES:LM-63-2019\nTILT=NONE\n", 180.0),
        ("ies: lm-63-2019 \r\n[TEST] LM-63-2002\r\nTILT=NONE\r\n", 180.0),
        (HEAD, 198.0),
        ("IESNA:LM-63-2002\n[OTHER] as LM-63-2019\nTILT=NONE\n", 198.0),
    ] {
        let lamp = decode(&text(head, &BODY.replacen("0.9 0.5", "0.9 1.10000", 1))).unwrap();
        assert!((lamp.candela[0] - largest).abs() < 1e-9, "{head}: {:?}", lamp.candela);
    }
}

#[test]
fn numbers_that_are_left_over_are_refused_with_their_place() {
    let end = "expected the end of the file after 3 x 1 candelas (commas part numbers), found";
    for (candelas, place, found) in [
        ("1,000 50 0", "9:10", "'0'"),
        ("100 50 0 7 8", "9:10", "'7'"),
        ("100 50 0\nwatts", "10:1", "'watts'"),
    ] {
        refused(&text(HEAD, &BODY.replacen("100 50 0", candelas, 1)), &format!("{place}: {end} {found}"));
    }
    // How DOS closed a text.
    assert!(decode(&text(HEAD, &format!("{BODY}\r\n\u{1A}"))).is_ok());
}

#[test]
fn lines_may_end_by_a_carriage_return_alone() {
    let old = text(HEAD, BODY).iter().filter(|&&b| b != b'\n').copied().collect::<Vec<u8>>();
    // The body has line feeds alone.
    let old = [&old[..HEAD.len() - 4], BODY.replace('\n', "\r").as_bytes()].concat();
    assert_eq!(decode(&old), decode(&text(HEAD, BODY)));
    let wrong = String::from_utf8(old).unwrap().replace("0.9", "x").into_bytes();
    refused(&wrong, "6:1: expected the ballast factor: above 0, found 'x'");
}

/// What is left out or hardly meant is said, with its place.
#[test]
fn notes_have_their_places() {
    let notes = |bytes: &[u8]| -> Vec<String> {
        decode(bytes).unwrap().notes.iter().map(|(place, note)| format!("{place}: {note}")).collect()
    };
    assert_eq!(notes(&text(HEAD, BODY)), [""; 0]);
    // Lumens count for nothing, be they unknown.
    assert_eq!(notes(&text(HEAD, &BODY.replacen("1000", "0", 1))), [""; 0]);
    assert_eq!(
        notes(&text("IESNA91\nTILT = C:\\Lamp.tlt\n", BODY)),
        ["2:1: the factors for tilt in 'C:\\Lamp.tlt' are left out: they do not apply to a fixed lamp"]
    );
    assert_eq!(
        notes(&text(HEAD, &BODY.replacen("100 50 0", "0 0 0", 1))),
        ["9:1: all candelas are 0: the lamp gives no light"]
    );
    let round =
        |last: &str| text(HEAD, &format!("1 -1 1 2 3 1 1 0 0 0 1 1 0\n0 90\n0 180 360\n1000 8 5 5\n{last}"));
    assert_eq!(notes(&round("1000.5 8")), [""; 0]);
    let seam = notes(&round("1000 10"));
    assert!(seam.len() == 1 && seam[0].starts_with("9:1: ") && seam[0].contains("2 cd off"), "{seam:?}");
}

#[test]
fn absolute_photometry_and_all_symmetries_are_read() {
    for (angles, count) in [("0 90", 2), ("0 90 180", 3), ("90 180 270", 3), ("0 180 360", 3)] {
        let candelas = "7 8 ".repeat(count);
        let body = format!("1 -1 1 2 {count} 1 1 0 0 0 1 1 0\n0 90\n{angles}\n{candelas}");
        let lamp = decode(&text(HEAD, &body)).unwrap();
        assert_eq!((lamp.horizontal_deg.len(), lamp.candela.len()), (count, 2 * count));
    }
    let both_sides = BODY.replace("0 45, 90", "0 90 180");
    assert_eq!(decode(&text(HEAD, &both_sides)).unwrap().vertical_deg, [0.0, 90.0, 180.0]);
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    refused(b"", "1:1: expected a line TILT=NONE or TILT=INCLUDE, found the end of the file");
    refused(
        b"IESNA91\nTILT=\n",
        "2:1: expected TILT=NONE, TILT=INCLUDE or the name of a file, found 'TILT='",
    );
    refused(b"\xff\xfeI\0E\0S\0", "1:1: expected a text in ASCII or UTF-8, found UTF-16, or no text");
    refused(b"I\0E\0S\0", "1:1: expected a text in ASCII or UTF-8, found UTF-16, or no text");
    let with = |from: &str, to: &str| text(HEAD, &BODY.replacen(from, to, 1));
    refused(
        &with("1 1 2 0.1", "1 2 2 0.1"),
        "5:14: expected the photometric type: 1 (type C; A and B are not supported), found '2'",
    );
    refused(&with("0 45, 90", "10 45 90"), "7:1: expected the first vertical angle: 0, found '10'");
    refused(&with("0 45, 90", "0 45 80"), "7:6: expected the last vertical angle: 90 or 180, found '80'");
    refused(
        &text(HEAD, "1 1 1 3 1 1 2 0 0 0 1 1 1\n0 0 90"),
        "6:3: expected a vertical angle: larger than the one before, found '0'",
    );
    let candelas = "expected candelas: 0 or more, and with all factors 1e12 at most, found";
    for (values, place, found) in [
        ("100 5e20 0", "9:5", "'5e20'"),
        ("100 -50 0", "9:5", "'-50'"),
        ("100 nan 0", "9:5", "'nan'"),
        ("100 50", "10:1", "the end of the file"),
    ] {
        refused(&with("100 50 0", values), &format!("{place}: {candelas} {found}"));
    }
    refused(&with("0.9 0.5", "0 0.5"), "6:1: expected the ballast factor: above 0, found '0'");
    refused(
        &with("2 3 1", "2 99999999 1"),
        "5:10: expected the number of vertical angles: a whole number from 2 up, with as many numbers to follow, found '99999999'",
    );
    refused(
        &text(HEAD, "1 1 1 2 3 1 2 0 0 0 1 1 1\n0 90\n0 90 200\n"),
        "7:6: expected the last horizontal angle: 90, 180 or 360, found '200'",
    );
}
