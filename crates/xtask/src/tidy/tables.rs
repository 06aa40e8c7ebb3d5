//! Markdown tables between markers, as ARCHITECTURE.md holds them.

/// The lines between `<!-- NAME:begin -->` and `<!-- NAME:end -->`, each with its number from 1.
pub fn section<'a>(document: &'a str, name: &str) -> Option<Vec<(usize, &'a str)>> {
    let begin = format!("<!-- {name}:begin -->");
    let end = format!("<!-- {name}:end -->");
    let mut lines = document.lines().enumerate().map(|(i, line)| (i + 1, line));
    lines.find(|(_, line)| line.contains(&begin))?;
    let mut inside = Vec::new();
    for (number, line) in lines {
        if line.contains(&end) {
            return Some(inside);
        }
        inside.push((number, line));
    }
    None
}

/// The cells of the rows of a table: no heading, no ruler, trimmed, without back quotes.
pub fn rows(section: &[(usize, &str)]) -> Vec<(usize, Vec<String>)> {
    let cells = |line: &str| -> Vec<String> {
        let inner = line.trim().trim_start_matches('|').trim_end_matches('|');
        inner.split('|').map(|cell| cell.trim().replace('`', "")).collect()
    };
    let is_ruler = |line: &str| line.contains("---") && line.chars().all(|c| "|-: ".contains(c));
    let table: Vec<_> = section.iter().filter(|(_, line)| line.trim_start().starts_with('|')).collect();
    let heading = usize::from(table.get(1).is_some_and(|(_, line)| is_ruler(line))) * 2;
    table.iter().skip(heading).map(|(number, line)| (*number, cells(line))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOCUMENT: &str =
        "text\n<!-- x:begin -->\n| a | b |\n|---|:-:|\n| `m` | k, l |\n<!-- x:end -->\nmore\n";

    #[test]
    fn rows_between_markers() {
        let section = section(DOCUMENT, "x").unwrap();
        assert_eq!(rows(&section), [(5, vec!["m".to_string(), "k, l".to_string()])]);
    }

    #[test]
    fn a_missing_marker_is_no_section() {
        assert!(section(DOCUMENT, "y").is_none());
        assert!(section("<!-- x:begin -->\n| a |\n", "x").is_none());
    }

    #[test]
    fn a_table_without_heading_keeps_its_first_row() {
        assert_eq!(rows(&[(1, "| a |"), (2, "| b |")]).len(), 2);
    }
}
