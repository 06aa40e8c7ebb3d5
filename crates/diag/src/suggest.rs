//! "Did you mean ...?"

/// The candidate nearest to a misspelt word, if one is near enough to be worth naming.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    closest(&normalized(word), candidates.into_iter().map(|c| (normalized(c), c)))
}

/// Candidates ready to be compared with many misspelt words.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    /// As it is compared, and as it is written.
    words: Vec<(Vec<char>, Box<str>)>,
}

impl Candidates {
    /// From the words as they are written; of several that are equally near, the first is named.
    pub fn new<'a>(words: impl IntoIterator<Item = &'a str>) -> Self {
        Self { words: words.into_iter().map(|w| (normalized(w), w.into())).collect() }
    }

    /// As [`nearest`].
    pub fn nearest(&self, word: &str) -> Option<&str> {
        closest(&normalized(word), self.words.iter().map(|(normalized, w)| (normalized, &**w)))
    }
}

fn closest<'a, W: AsRef<[char]>>(
    word: &[char],
    candidates: impl Iterator<Item = (W, &'a str)>,
) -> Option<&'a str> {
    let limit = (word.len() / 3).clamp(1, 4);
    candidates
        // Each letter more or less is a step of the distance.
        .filter(|(c, _)| !c.as_ref().is_empty() && c.as_ref().len().abs_diff(word.len()) <= limit)
        .map(|(c, written)| (distance(word, c.as_ref()), written))
        .filter(|&(d, _)| d <= limit)
        .min_by_key(|&(d, _)| d)
        .map(|(_, written)| written)
}

/// The most letters that are compared: nobody types a longer word.
const LONGEST: usize = 64;

/// Spelling without what people vary most: case, blanks, dashes and underscores, colour and color.
fn normalized(word: &str) -> Vec<char> {
    let letters: String = word.chars().filter(|c| !matches!(c, ' ' | '-' | '_')).take(LONGEST).collect();
    letters.to_lowercase().replace("color", "colour").chars().collect()
}

/// Edit distance with transpositions of neighbours (optimal string alignment).
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = vec![];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let substitution = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = substitution.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_the_likely_word_and_stays_silent_otherwise() {
        let names = ["max_depth", "metropolis", "width", "height", "colour"];
        assert_eq!(nearest("maxdepth", names), Some("max_depth"));
        assert_eq!(nearest("metropolsi", names), Some("metropolis"));
        assert_eq!(nearest("wdith", names), Some("width"));
        assert_eq!(nearest("color", names), Some("colour"));
        assert_eq!(nearest("zzz", names), None);
        let candidates = Candidates::new(names);
        assert_eq!(candidates.nearest("Max-Dept"), Some("max_depth"));
        assert_eq!(candidates.nearest("zzz"), None);
    }
}
