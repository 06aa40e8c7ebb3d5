//! Rust source with everything taken out that is not code.

/// The source with comments and the contents of literals replaced by blanks, and with modules under
/// `#[cfg(test)]` blanked altogether. Lines keep their numbers.
pub fn code_only(source: &str) -> String {
    without_tests(&without_prose(source))
}

/// Where the scanner is.
#[derive(Clone, Copy)]
enum State {
    Code,
    LineComment,
    BlockComment(u32),
    /// Inside quotes; raw strings end at a quote and so many `#`.
    Text {
        raw: Option<usize>,
    },
}

fn without_prose(source: &str) -> String {
    let chars: Vec<char> = source.chars().collect();
    let mut out = String::with_capacity(source.len());
    let mut state = State::Code;
    let mut i = 0;
    while i < chars.len() {
        let (next, length) = step(state, &chars[i..], i.checked_sub(1).map(|j| chars[j]));
        let stays = matches!(state, State::Code) && matches!(next, State::Code);
        for &c in &chars[i..i + length] {
            // A literal of one character is code to the scanner, and blanked all the same.
            let keep = c == '\n' || (stays && length == 1);
            out.push(if keep { c } else { ' ' });
        }
        state = next;
        i += length;
    }
    out
}

/// The state after the next token and the token's length in characters (at least 1).
fn step(state: State, rest: &[char], previous: Option<char>) -> (State, usize) {
    match state {
        State::Code => step_code(rest, previous),
        State::LineComment if rest[0] == '\n' => (State::Code, 1),
        State::LineComment => (state, 1),
        State::BlockComment(depth) if rest.starts_with(&['/', '*']) => (State::BlockComment(depth + 1), 2),
        State::BlockComment(1) if rest.starts_with(&['*', '/']) => (State::Code, 2),
        State::BlockComment(depth) if rest.starts_with(&['*', '/']) => (State::BlockComment(depth - 1), 2),
        State::BlockComment(_) => (state, 1),
        State::Text { raw: None } if rest[0] == '\\' => (state, rest.len().min(2)),
        State::Text { raw: None } if rest[0] == '"' => (State::Code, 1),
        State::Text { raw: Some(hashes) } if rest[0] == '"' && count_hashes(&rest[1..]) >= hashes => {
            (State::Code, 1 + hashes)
        }
        State::Text { .. } => (state, 1),
    }
}

fn step_code(rest: &[char], previous: Option<char>) -> (State, usize) {
    let after_word = previous.is_some_and(|c| c.is_alphanumeric() || c == '_');
    match rest {
        ['/', '/', ..] => (State::LineComment, 2),
        ['/', '*', ..] => (State::BlockComment(1), 2),
        ['"', ..] => (State::Text { raw: None }, 1),
        ['r', tail @ ..] if !after_word || previous == Some('b') => {
            let hashes = count_hashes(tail);
            if tail.get(hashes) == Some(&'"') {
                (State::Text { raw: Some(hashes) }, hashes + 2)
            } else {
                (State::Code, 1)
            }
        }
        ['\'', ..] => (State::Code, character_literal(rest)),
        _ => (State::Code, 1),
    }
}

fn count_hashes(chars: &[char]) -> usize {
    chars.iter().take_while(|&&c| c == '#').count()
}

/// The length of a character literal, or 1 for a lifetime's apostrophe.
fn character_literal(rest: &[char]) -> usize {
    match rest {
        ['\'', '\\', _, tail @ ..] => 3 + tail.iter().position(|&c| c == '\'').map_or(0, |at| at + 1),
        ['\'', _, '\'', ..] => 3,
        _ => 1,
    }
}

/// Blanks each item that follows `#[cfg(test)]`.
fn without_tests(code: &str) -> String {
    const MARK: &str = "#[cfg(test)]";
    let mut out = String::with_capacity(code.len());
    let mut rest = code;
    while let Some(at) = rest.find(MARK) {
        let end = at + item_length(&rest[at..]);
        out.push_str(&rest[..at]);
        out.extend(rest[at..end].chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
        rest = &rest[end..];
    }
    out.push_str(rest);
    out
}

/// The length of the text up to the end of the first item: a `;` or a closed pair of braces.
fn item_length(code: &str) -> usize {
    let mut depth = 0u32;
    for (at, c) in code.char_indices() {
        match c {
            ';' if depth == 0 => return at + 1,
            '{' => depth += 1,
            '}' if depth <= 1 => return at + 1,
            '}' => depth -= 1,
            _ => {}
        }
    }
    code.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_literals_are_blanked() {
        let squeezed = |source: &str| code_only(source).split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(squeezed("a(); // b()\nc();"), "a(); c();");
        assert_eq!(squeezed("a /* b /* c */ d */ e"), "a e");
        assert_eq!(squeezed(r#"f("x \" y") + 1"#), "f( ) + 1");
        assert_eq!(squeezed("g(r#\"raw \" text\"#, 2)"), "g( , 2)");
        assert_eq!(squeezed(r"h('\'', '{', x) fn k<'a>()"), "h( , , x) fn k<'a>()");
    }

    #[test]
    fn lines_keep_their_numbers() {
        let source = "a\n/* b\nc */\n\"d\ne\"\nf\n";
        let code = code_only(source);
        assert_eq!(code.lines().count(), source.lines().count());
        assert_eq!(code.lines().nth(5), Some("f"));
    }

    #[test]
    fn test_modules_are_left_out_and_what_follows_is_not() {
        let code = code_only(
            "a();\n#[cfg(test)]\nmod tests {\n fn x() { y() }\n}\nb();\n#[cfg(test)]\nmod t;\nc();\n",
        );
        let lines: Vec<&str> = code.lines().map(str::trim).collect();
        assert_eq!(lines, ["a();", "", "", "", "", "b();", "", "", "c();"]);
    }
}
