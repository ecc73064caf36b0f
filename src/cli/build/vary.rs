//! What varies from one picture of a batch to the next: `NAME=V1,V2,…` and seeds in, the cells of the matrix out.

use crate::cli::limits::parse_set;
use crate::diag::grouped;

use super::{BuildArgs, Kind, Seeds, kind_of};

/// What the seed is called among the names of what varies.
pub(super) const SEED: &str = "seed";
/// What the number of a picture is called.
pub(super) const NUMBER: &str = "n";

/// A parameter with the values that it is given one after the other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::cli) struct Vary {
    /// The parameter's name.
    pub(in crate::cli) name: String,
    /// Its values as they are written; each is there once.
    pub(in crate::cli) values: Vec<String>,
}

/// Reads `NAME=V1,V2,…`. Commas in brackets and strings belong to a value.
pub(in crate::cli) fn parse(text: &str) -> Result<Vary, String> {
    let (name, list) = parse_set(text).map_err(|_| "expected NAME=V1,V2,…".to_owned())?;
    let values: Vec<String> = split(&list)?.into_iter().map(|value| value.trim().to_owned()).collect();
    for (i, value) in values.iter().enumerate() {
        if value.is_empty() {
            return Err("a value is missing: there is nothing before or behind a comma".to_owned());
        }
        if values[..i].contains(value) {
            return Err(format!("`{name}` is given {value} twice"));
        }
    }
    Ok(Vary { name, values })
}

/// Cuts a text at its commas, but for those in brackets and strings.
fn split(text: &str) -> Result<Vec<&str>, String> {
    // What is open, by the character that closes it; a string may hold expressions in braces.
    let mut open: Vec<char> = Vec::new();
    let (mut parts, mut start) = (Vec::new(), 0);
    let mut characters = text.char_indices();
    while let Some((at, character)) = characters.next() {
        let is_string = open.last() == Some(&'"');
        match character {
            '\\' if is_string => {
                characters.next();
            }
            closing if open.last() == Some(&closing) => {
                open.pop();
            }
            '{' => open.push('}'),
            _ if is_string => {}
            '"' => open.push('"'),
            '(' => open.push(')'),
            '[' => open.push(']'),
            ')' | ']' | '}' => return Err(format!("`{character}` closes nothing in `{text}`")),
            ',' if open.is_empty() => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    if let Some(closing) = open.last() {
        return Err(format!("`{closing}` is missing in `{text}`"));
    }
    parts.push(&text[start..]);
    Ok(parts)
}

/// What of a batch a command line can be refused for.
pub(super) fn check(arguments: &BuildArgs) -> Result<(), String> {
    for (i, vary) in arguments.vary.iter().enumerate() {
        let name = &vary.name;
        if arguments.vary[..i].iter().any(|other| other.name == *name) {
            return Err(format!("`{name}` is varied twice: give all its values behind one `--vary`"));
        }
        if arguments.scene.set.iter().any(|(set, _)| set == name) {
            return Err(format!("`{name}` cannot be set and varied: leave out `--set {name}=…` or `--vary {name}=…`"));
        }
        if name == SEED && arguments.seeds.is_some() {
            return Err("`{seed}` would be the scene's seed and the parameter `seed`: vary one of them".to_owned());
        }
    }
    if let Some(sheet) = &arguments.sheet {
        let is_picture = matches!(kind_of(sheet), Ok(Kind::Svg | Kind::Png | Kind::Pdf));
        if !is_picture || sheet.as_os_str() == "-" {
            return Err(format!("{}: a sheet is a file that ends in .svg, .png or .pdf", sheet.display()));
        }
    }
    let most = arguments.scene.limits().runs;
    let all = axes_lengths(arguments).try_fold(1_u64, u64::checked_mul).unwrap_or(u64::MAX);
    if all > most {
        let (all, most) = (if all == u64::MAX { "too many".to_owned() } else { grouped(all) }, grouped(most));
        return Err(format!("{all} pictures are asked for; the limit is {most}: `--limit runs=N` lifts it"));
    }
    Ok(())
}

fn axes_lengths(arguments: &BuildArgs) -> impl Iterator<Item = u64> {
    let seeds = arguments.seeds.map(|Seeds(from, to)| (to - from).saturating_add(1));
    arguments.vary.iter().map(|vary| vary.values.len() as u64).chain(seeds)
}

/// Everything that varies, in the order it was given; seeds come last, as parameters called `seed`.
pub(super) fn axes(arguments: &BuildArgs) -> Vec<Vary> {
    let seeds = arguments.seeds.map(|Seeds(from, to)| Vary {
        name: SEED.to_owned(),
        values: (from..=to).map(|seed| seed.to_string()).collect(),
    });
    arguments.vary.iter().cloned().chain(seeds).collect()
}

/// A picture of a batch.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cell {
    /// What varies, with the values it has here.
    pub(super) values: Vec<(String, String)>,
    /// Whether the last value is the scene's seed.
    has_seed: bool,
}

impl Cell {
    /// The parameters among what varies.
    pub(super) fn sets(&self) -> &[(String, String)] {
        let params = self.values.len() - usize::from(self.has_seed);
        &self.values[..params]
    }

    /// The seed, where that varies.
    pub(super) fn seed(&self) -> Option<u64> {
        let (_, seed) = self.values.last().filter(|_| self.has_seed)?;
        seed.parse().ok()
    }

    /// What it is called in words.
    pub(super) fn name(&self) -> String {
        self.values.iter().map(|(name, value)| label(name, value)).collect::<Vec<_>>().join(", ")
    }
}

/// A value with the name of what has it.
pub(super) fn label(name: &str, value: &str) -> String {
    if name == SEED { format!("seed {value}") } else { format!("{name} = {value}") }
}

/// Every combination, the last of what varies fastest.
pub(super) fn cells(axes: &[Vary], has_seed: bool) -> Vec<Cell> {
    let mut cells = vec![Vec::new()];
    for axis in axes {
        let with = |cell: &Vec<(String, String)>| {
            let cell = cell.clone();
            axis.values.iter().map(move |value| [&cell[..], &[(axis.name.clone(), value.clone())]].concat())
        };
        cells = cells.iter().flat_map(with).collect();
    }
    cells.into_iter().map(|values| Cell { values, has_seed }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        parse(text).map(|vary| vary.values).unwrap_or_else(|words| vec![format!("error: {words}")])
    }

    #[test]
    fn commas_in_brackets_and_strings_do_not_split() {
        assert_eq!(values("tile=4mm, 6mm,8mm"), ["4mm", "6mm", "8mm"]);
        let split = values(r#"p=poisson(radius: 4mm, tries: 5),[1, 2],"a, \"b, {f(1, "c,")}",{ a: 1, b: 2 }"#);
        let wanted = ["poisson(radius: 4mm, tries: 5)", "[1, 2]", r#""a, \"b, {f(1, "c,")}""#, "{ a: 1, b: 2 }"];
        assert_eq!(split, wanted);
        assert_eq!(values("look=squares,cells"), ["squares", "cells"]);
    }

    #[test]
    fn what_is_no_list_is_refused() {
        for (text, words) in [
            ("tile", "expected"),
            ("=1", "expected"),
            ("tile=", "missing"),
            ("tile=1,,2", "missing"),
            ("tile=1,2,", "missing"),
            ("tile=1,2,1", "twice"),
            ("a=(1,2", "`)` is missing"),
            ("a=1),2", "closes nothing"),
            ("a=\"x,y", "`\"` is missing"),
        ] {
            let said = parse(text).expect_err(text);
            assert!(said.contains(words), "{text}: {said}");
        }
    }

    #[test]
    fn the_last_varies_fastest() {
        let axes = ["a=1,2", "seed=7,8"].map(|text| parse(text).expect("it is a list"));
        let cells = cells(&axes, true);
        let names: Vec<String> = cells.iter().map(Cell::name).collect();
        assert_eq!(names, ["a = 1, seed 7", "a = 1, seed 8", "a = 2, seed 7", "a = 2, seed 8"]);
        assert_eq!((cells[1].seed(), cells[1].sets()), (Some(8), &[("a".to_owned(), "1".to_owned())][..]));
    }
}
