/// Returns the rows of a table in text: a row a line, its cells between `=>`, with `\\n` where a
/// cell has a line end.
///
/// Empty lines and those that begin with `//` are no rows.
pub fn rows<const N: usize>(table: &str) -> impl Iterator<Item = [String; N]> {
    let lines = table.lines().map(str::trim);
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with("//"));
    lines.map(|line| {
        let cells = line
            .split("=>")
            .map(|cell| cell.trim().replace("\\n", "\n"));
        let cells: Vec<String> = cells.collect();
        cells
            .try_into()
            .unwrap_or_else(|_| panic!("{N} cells: {line}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_trimmed_and_may_hold_line_ends() {
        let table = "\n  a = 1\\nb => c | d\n// none\n => e\n";
        let found: Vec<[String; 2]> = rows(table).collect();
        assert_eq!(found, [["a = 1\nb", "c | d"], ["", "e"]]);
    }

    #[test]
    #[should_panic(expected = "3 cells: a => b")]
    fn rows_have_all_cells() {
        let _ = rows::<3>("a => b").count();
    }
}
