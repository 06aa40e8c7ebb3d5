//! The watermark: the program's name in the lower right corner.
//!
//! Its letters are drawn from small bitmaps, so that it needs no font, and grow with the picture. Each is white with a
//! dark shadow, so that it reads on any ground.

use crate::Picture;

/// What it says.
const TEXT: &str = "Indigo Renderer";
/// Columns and rows of a letter.
const LETTER: [usize; 2] = [5, 7];
/// Columns from one letter to the next.
const ADVANCE: usize = LETTER[0] + 1;
/// Rows of a picture for each pixel that a dot of a letter is wide: the text takes about a quarter of the width of
/// a picture of 4 : 3.
const ROWS_PER_DOT: usize = 225;
/// How much of the light that was there a letter and a shadow leave.
const SEEN_THROUGH: f32 = 0.3;

/// Rows of a letter from top to bottom; the highest of five bits is its left column.
fn rows(letter: char) -> [u8; LETTER[1]] {
    match letter {
        'I' => [0b01110, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110],
        'R' => [0b11110, 0b10001, 0b10001, 0b11110, 0b10100, 0b10010, 0b10001],
        'd' => [0b00001, 0b00001, 0b01101, 0b10011, 0b10001, 0b10011, 0b01101],
        'e' => [0b00000, 0b00000, 0b01110, 0b10001, 0b11111, 0b10000, 0b01110],
        'g' => [0b00000, 0b00000, 0b01111, 0b10001, 0b01111, 0b00001, 0b01110],
        'i' => [0b00100, 0b00000, 0b01100, 0b00100, 0b00100, 0b00100, 0b01110],
        'n' => [0b00000, 0b00000, 0b10110, 0b11001, 0b10001, 0b10001, 0b10001],
        'o' => [0b00000, 0b00000, 0b01110, 0b10001, 0b10001, 0b10001, 0b01110],
        'r' => [0b00000, 0b00000, 0b10110, 0b11001, 0b10000, 0b10000, 0b10000],
        _ => [0; LETTER[1]],
    }
}

/// Whether a dot of the text is set.
fn is_set(column: usize, row: usize) -> bool {
    let letter = TEXT.chars().nth(column / ADVANCE).unwrap_or(' ');
    let within = column % ADVANCE;
    within < LETTER[0] && row < LETTER[1] && rows(letter)[row] >> (LETTER[0] - 1 - within) & 1 == 1
}

/// Draws it. What does not fit into the picture is cut off on the left and at the top.
pub(crate) fn draw(picture: &mut Picture) {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let dot = (height / ROWS_PER_DOT).max(1);
    let columns = TEXT.chars().count() * ADVANCE;
    // One dot of margin, and one for the shadow.
    for (y, line) in picture.pixels.chunks_exact_mut(width).rev().enumerate().take(dot * (LETTER[1] + 2)) {
        for (x, pixel) in line.iter_mut().rev().enumerate().take(dot * (columns + 1)) {
            // Columns and rows of dots from the right and from below; the margin is column and row 0.
            let (from_right, from_below) = (x / dot, y / dot);
            let set = |right: usize, below: usize| {
                let column = (columns + 1).checked_sub(1 + right);
                let row = LETTER[1].checked_sub(below);
                column.zip(row).is_some_and(|(c, r)| below > 0 && is_set(c, r))
            };
            let light = if set(from_right, from_below) {
                Some(1.0)
            } else if set(from_right + 1, from_below + 1) {
                Some(0.0)
            } else {
                None
            };
            if let Some(light) = light {
                for v in &mut pixel[..3] {
                    *v = light + (*v - light) * SEEN_THROUGH;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marked(width: u32, height: u32, light: f32) -> Picture {
        let pixels = vec![[light, light, light, 1.0]; (width * height) as usize];
        let mut picture = Picture { width, height, pixels };
        draw(&mut picture);
        picture
    }

    #[test]
    fn it_stands_in_the_lower_right_corner_on_any_ground() {
        for (width, height) in [(400, 300), (1200, 900)] {
            for light in [0.0, 0.5, 1.0] {
                let picture = marked(width, height, light);
                let changed: Vec<(u32, u32)> = (0..width * height)
                    .filter(|&i| picture.pixels[i as usize][0] != light)
                    .map(|i| (i % width, i / width))
                    .collect();
                assert!(changed.len() > 100, "{light}: nothing to be seen");
                assert!(changed.iter().all(|&(x, y)| x >= width / 2 && y >= height * 9 / 10));
                assert!(picture.pixels.iter().all(|p| p[3] == 1.0));
            }
        }
    }

    #[test]
    fn it_grows_with_the_picture() {
        let count = |height| {
            let picture = marked(height * 4 / 3, height, 0.0);
            picture.pixels.iter().filter(|p| p[0] > 0.0).count()
        };
        assert_eq!(9 * count(225), count(675));
    }

    /// The dots that are set, counted off the bitmaps, are the white ones.
    #[test]
    fn letters_are_drawn_once_and_whole() {
        let dots: u32 = TEXT.chars().flat_map(rows).map(u8::count_ones).sum();
        let white = marked(300, 200, 0.0).pixels.iter().filter(|p| p[0] > 0.0).count();
        assert_eq!(white as u32, dots);
    }

    #[test]
    fn small_pictures_get_what_fits() {
        for (width, height) in [(1, 1), (3, 20), (200, 2), (17, 5)] {
            assert_eq!(marked(width, height, 0.5).pixels.len(), (width * height) as usize);
        }
    }
}
