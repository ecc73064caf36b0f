//! Figures for people.

use crate::metrics::correlogram::Correlogram;
use crate::metrics::{Measures, Scalars};
use crate::stats::{Summary, summary};

use super::Entry;

/// Columns of a table of several seeds.
const WIDTH: usize = 100;

/// What the last two rows of such a table are called.
const MEAN: &str = "mean";
const DEVIATION: &str = "sd";

/// What figures say, and why they may say nothing. Figures that are not named here stand for themselves.
const WORDS: [(&str, &str, &str); 32] = [
    ("e_contrast", "how far neighbours are turned apart", ""),
    ("e_bound", "the most that these links allow", "links are no triangulation of the plane"),
    ("e_share", "what of that is reached", "links are no triangulation of the plane"),
    ("p5_contrast", "95 % of the links have more", "no links"),
    ("min_contrast", "the least of a link", "no links"),
    ("e_contrast_layers", "contrast of the nearest layers", "no links between tiles with strokes"),
    ("p5_contrast_layers", "95 % of the links have more", "no links between tiles with strokes"),
    ("e_contrast_k", "contrast, weighted by k", "no k on any link"),
    ("e_contrast_tangent", "contrast where strokes leave their tiles", "no links, or strokes not known"),
    ("h_angle", "diversity of directions", ""),
    ("h_angle_mean", "the same wherever bins start", ""),
    ("joint", "e_contrast times h_angle", ""),
    ("xi", "correlation length in links", "fewer than two distances"),
    ("xi_r2", "how well the exponential fits", "nothing was fitted"),
    ("xi_r2_weighted", "the same with the weights of the fit", "nothing was fitted"),
    ("xi_at_bound", "1 where the fit ended on a bound", "nothing was fitted"),
    ("decay_a", "exponent of the power law", "nothing was fitted"),
    ("aicc_exp", "AICc of the exponential", "too few distances"),
    ("aicc_power", "AICc of the power law", "too few distances"),
    ("decay_power", "1 where the power law says it better", "too few distances"),
    ("r_hat_peak", "strongest frequency, radians a link", "no links"),
    ("c_cov", "share of the region that tiles cover", "no tiles, or no region"),
    ("u_vor", "unevenness of the cells", "fewer than two tiles, or no region"),
    ("density_contrast", "how much neighbours differ in ink", "no links, or fills not known"),
    ("tile_isotropy", "how evenly strokes cross in a tile", "no tile has strokes, or fills not known"),
    ("ssim", "likeness to the reference picture", ""),
    ("grain", "how much of a grain the pattern has", "too few tiles, links or triangles"),
    ("grain_contrast", "neighbours part everywhere", "no links"),
    ("grain_directions", "many directions wherever one looks", "too few tiles or links"),
    ("grain_evenness", "tiles lie evenly", "too few tiles or triangles"),
    ("grain_disorder", "tiles stand in no rows", "too few tiles or triangles"),
    ("grain_looseness", "cells are not cut to one measure", "too few tiles or triangles"),
];

/// The text for all entries; those of one paint follow each other.
pub(super) fn text(entries: &[Entry]) -> String {
    let paints = entries.chunk_by(|a, b| a.paint == b.paint && a.seed != b.seed);
    let texts = paints.map(|paint| match paint {
        [entry] => single(entry),
        several => seeds(several),
    });
    texts.collect::<Vec<_>>().join("\n")
}

/// Whether a figure belongs to the correlogram, which has lines of its own.
fn is_of_correlogram(name: &str) -> bool {
    name == "sampled" || name.strip_prefix('r').is_some_and(|k| k.parse::<u32>().is_ok())
}

fn heading(paint: &str, measures: &Measures, seed: Option<u64>) -> String {
    let counted = |n: usize, one: &str| if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") };
    let seed = seed.map_or_else(String::new, |seed| format!(", seed {seed}"));
    format!("{paint}: {}, {}{seed}\n", counted(measures.tiles, "tile"), counted(measures.edges, "link"))
}

/// One line a figure, then the correlogram.
fn single(entry: &Entry) -> String {
    let mut text = heading(&entry.paint, &entry.measures, entry.seed);
    let scalars: Scalars = entry.scalars();
    let figures =
        || scalars.iter().filter(|(name, _)| !matches!(&**name, "tiles" | "edges") && !is_of_correlogram(name));
    let width = figures().map(|(name, _)| name.len()).max().unwrap_or(0);
    let at_bound = entry.measures.decay.xi_at_bound == Some(true);
    for (name, value) in figures() {
        let words = WORDS.iter().find(|(known, ..)| known == name);
        let note = match (value, words) {
            (Some(_), _) if name == "xi" && at_bound => "on a bound of the fit, so no more than that",
            (Some(_), Some((_, meaning, _))) => meaning,
            (None, Some((_, _, why))) => why,
            (_, None) => "",
        };
        text += format!("  {name:width$}  {:>9}  {note}", number(*value)).trim_end();
        text.push('\n');
    }
    text + &correlogram(&entry.measures.correlogram)
}

/// R_k with what stands behind each.
fn correlogram(correlogram: &Correlogram) -> String {
    if correlogram.r.is_empty() {
        return String::new();
    }
    let sampled = correlogram.sampled.map_or_else(String::new, |n| format!("  from a sample of {n} tiles"));
    let mut text = format!("\n   k       pairs        R_k{sampled}\n");
    for (i, (r, pairs)) in correlogram.r.iter().zip(&correlogram.pairs).enumerate() {
        let error = correlogram.r_se.as_ref().and_then(|errors| errors.get(i));
        let error = error.map_or_else(String::new, |error| format!("  +- {error:.4}"));
        text += &format!("  {:>2}  {pairs:>10}  {:>9}{error}\n", i + 1, number(Some(*r)));
    }
    text
}

/// One row a seed, then their mean and deviation; as many figures beside each other as the width allows.
fn seeds(entries: &[Entry]) -> String {
    let mut text = format!("{}: {} seeds\n", entries[0].paint, entries.len());
    let rows: Vec<Scalars> = entries.iter().map(Entry::scalars).collect();
    let columns = (0..rows[0].len()).filter(|&i| rows.iter().any(|row| row[i].1.is_some()));
    let columns: Vec<usize> = columns.filter(|&i| rows[0][i].0 != "sampled").collect();
    let labels = entries.iter().map(|entry| entry.seed.map(|seed| seed.to_string()).unwrap_or_default());
    let labels: Vec<String> = labels.chain([MEAN.to_owned(), DEVIATION.to_owned()]).collect();
    let summaries = |column: usize| summary(&rows.iter().filter_map(|row| row[column].1).collect::<Vec<f64>>());
    let summaries: Vec<Option<Summary>> = (0..rows[0].len()).map(summaries).collect();
    let first = labels.iter().map(String::len).max().unwrap_or(0).max("seed".len());
    let width = |column: usize| rows[0][column].0.len().max(9);
    let mut rest = &columns[..];
    while !rest.is_empty() {
        let mut used = first + 2;
        let fits = rest.iter().take_while(|&&column| {
            used += width(column) + 2;
            used <= WIDTH
        });
        let (block, after) = rest.split_at(fits.count().max(1));
        rest = after;
        text += &format!("\n  {:>first$}", "seed");
        for &column in block {
            text += &format!("  {:>1$}", rows[0][column].0, width(column));
        }
        text.push('\n');
        for (i, label) in labels.iter().enumerate() {
            text += &format!("  {label:>first$}");
            for &column in block {
                let value = match (rows.get(i), &summaries[column]) {
                    (Some(row), _) => row[column].1,
                    (None, None) => None,
                    (None, Some(all)) => {
                        if label == MEAN {
                            Some(all.mean)
                        } else {
                            all.sd
                        }
                    }
                };
                let is_count = i < rows.len() && matches!(&*rows[0][column].0, "tiles" | "edges");
                let value = if is_count { whole(value) } else { number(value) };
                text += &format!("  {value:>0$}", width(column));
            }
            text.push('\n');
        }
    }
    text
}

/// A figure with as many digits as one reads.
fn number(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(value) if value != 0.0 && !(1e-4..1e5).contains(&value.abs()) => format!("{value:.2e}"),
        // Nothing below zero is left of what rounds to it.
        Some(value) => format!("{:.4}", if value.abs() < 5e-5 { 0.0 } else { value }),
    }
}

fn whole(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.0}"))
}
