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
    refused(b"IESNA91\nTILT=a.tlt\n", "2:1: expected TILT=NONE or TILT=INCLUDE, found 'TILT=a.tlt'");
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
