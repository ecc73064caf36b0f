//! Matrices: a value for every pair, as a colour and as a number.

use colorous::{Color, Gradient};

use super::Titles;
use super::axis::finite;
use super::sheet::{Anchor, FAINT, INK, LARGE, SMALL, Sheet, TEXT, shortened, width_of};

/// From the least negative to the greatest value; zero is white.
const COLOURS: Gradient = colorous::RED_BLUE;

/// The part of the gradient on either side of its middle that dark text is read on.
const PALE: f64 = 0.3;

const CELL: [f64; 2] = [62.0, 24.0];
const NAMES: f64 = 200.0;

/// Draws a value for each row and column: blue above zero, red below, white at zero and where there is none. Where
/// columns have long names they are numbered as the rows are.
#[must_use]
pub fn matrix(titles: &Titles<'_>, rows: &[&str], columns: &[&str], values: &[Vec<Option<f64>>]) -> String {
    let names = rows.iter().map(|name| width_of(name, TEXT)).fold(0.0, f64::max).min(NAMES);
    let left = 18.0 + names;
    let width = (left + CELL[0] * columns.len() as f64 + 16.0).max(width_of(titles.title, LARGE) + 24.0);
    let top = 58.0;
    let mut sheet = Sheet::new(width, top + CELL[1] * rows.len() as f64 + 16.0, titles.title);
    let value = |row: usize, column: usize| values.get(row)?.get(column).copied().flatten().and_then(finite);
    let all = || (0..rows.len()).flat_map(|row| (0..columns.len()).filter_map(move |column| value(row, column)));
    let greatest = all().fold(0.0f64, |greatest, value| greatest.max(value.abs()));
    for (column, name) in columns.iter().enumerate() {
        let x = left + CELL[0] * (column as f64 + 0.5);
        sheet.text([x, top - 7.0], Anchor::Middle, SMALL, INK, &shortened(name, SMALL, CELL[0] - 4.0));
    }
    for (row, name) in rows.iter().enumerate() {
        let y = top + CELL[1] * row as f64;
        let middle = y + CELL[1] / 2.0 + 4.0;
        sheet.text([left - 8.0, middle], Anchor::End, TEXT, INK, &shortened(name, TEXT, NAMES));
        for column in 0..columns.len() {
            let x = left + CELL[0] * column as f64;
            let found = value(row, column);
            let share = found.map_or(0.0, |value| if greatest > 0.0 { value / greatest } else { 0.0 });
            let Color { r, g, b } = COLOURS.eval_continuous(0.5 + share * PALE);
            let fill = if share == 0.0 { "#ffffff".to_owned() } else { format!("#{r:02x}{g:02x}{b:02x}") };
            sheet.rectangle([x, y], [x + CELL[0], y + CELL[1]], &fill, 1.0, FAINT);
            let text = found.map_or_else(|| "\u{2013}".to_owned(), digits);
            sheet.text([x + CELL[0] / 2.0, middle], Anchor::Middle, SMALL, INK, &text);
        }
    }
    sheet.finish()
}

/// A number with about three digits.
fn digits(value: f64) -> String {
    let text = match value.abs() {
        size if size >= 1e5 => format!("{value:.1e}"),
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    };
    // What rounds to zero has no sign.
    if text == "-0.00" { "0.00".to_owned() } else { text.replace('-', "\u{2212}") }
}
