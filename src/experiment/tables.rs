//! The tables of an experiment as CSV: one row a run, and the statistics in long form.
//!
//! Every number stands with the fewest digits that give it back; what cannot be said is an empty field.

use crate::stats::Summary;

use super::{Analysis, Outcome};

/// The name of the column that says which paint a row is about, where there are several.
pub const PAINT: &str = "paint";

/// The tables by their files' names.
///
/// # Errors
/// If a table cannot be put together, which memory alone could be the reason for.
pub fn tables(outcome: &Outcome) -> csv::Result<Vec<(&'static str, Vec<u8>)>> {
    Ok(vec![
        ("runs.csv", runs(outcome)?),
        ("summary.csv", summary(outcome)?),
        ("anova.csv", anova(outcome)?),
        ("assumptions.csv", assumptions(outcome)?),
        ("cohen_d.csv", cohen_d(outcome)?),
        ("tukey.csv", tukey(outcome)?),
    ])
}

/// One row for each paint of each run: the parameters, the seed, and every measure.
///
/// # Errors
/// As [`tables`].
pub fn runs(outcome: &Outcome) -> csv::Result<Vec<u8>> {
    let plan = &outcome.plan;
    let mut table = Table::new(outcome);
    let params = plan.params.iter().map(|param| param.name.clone());
    table.head(params.chain(["seed".to_owned()]), outcome.measures.iter().cloned())?;
    for run in &outcome.runs {
        let labels = plan.conditions[run.condition].labels.iter().cloned();
        let values = run.values.iter().map(|value| optional(*value));
        table.row(labels.chain([run.seed.to_string()]), run.paint, values)?;
    }
    table.finish()
}

fn summary(outcome: &Outcome) -> csv::Result<Vec<u8>> {
    let plan = &outcome.plan;
    let mut table = Table::new(outcome);
    let params = plan.params.iter().map(|param| param.name.clone());
    let figures = ["measure", "n", "mean", "sd", "min", "q1", "median", "q3", "max"];
    table.head(["condition".to_owned()].into_iter().chain(params), figures.map(str::to_owned))?;
    for (condition, of) in plan.conditions.iter().enumerate() {
        for analysis in &outcome.analyses {
            let Some(summary) = &analysis.summaries[condition] else { continue };
            let Summary { n, mean, sd, min, q1, median, q3, max } = *summary;
            let figures =
                [number(mean), optional(sd), number(min), number(q1), number(median), number(q3), number(max)];
            let first = [outcome.measures[analysis.measure].clone(), n.to_string()];
            let names = [of.name.clone()].into_iter().chain(of.labels.iter().cloned());
            table.row(names, analysis.paint, first.into_iter().chain(figures))?;
        }
    }
    table.finish()
}

fn anova(outcome: &Outcome) -> csv::Result<Vec<u8>> {
    let columns = ["measure", "source", "ss", "df", "f", "p", "eta2", "omega2", "note"];
    long(outcome, &columns, |_, analysis, row| {
        let note = || analysis.anova.note.clone().unwrap_or_default();
        for source in &analysis.anova.rows {
            let figures = [
                number(source.ss),
                source.df.to_string(),
                optional(source.f),
                optional(source.p),
                optional(source.eta2),
            ];
            row([source.source.clone()].into_iter().chain(figures).chain([optional(source.omega2), note()]).collect())?;
        }
        // Where there is no table, the reason stands alone.
        if analysis.anova.rows.is_empty() {
            row((0..7).map(|_| String::new()).chain([note()]).collect())?;
        }
        Ok(())
    })
}

fn assumptions(outcome: &Outcome) -> csv::Result<Vec<u8>> {
    let columns = ["measure", "shapiro_w", "shapiro_p", "levene_f", "levene_p", "note"];
    long(outcome, &columns, |_, analysis, row| {
        let found = &analysis.assumptions;
        let figures = [found.shapiro_w, found.shapiro_p, found.levene_f, found.levene_p].map(optional);
        row(figures.into_iter().chain([found.note.clone().unwrap_or_default()]).collect())
    })
}

fn cohen_d(outcome: &Outcome) -> csv::Result<Vec<u8>> {
    long(outcome, &["measure", "group1", "group2", "d"], |outcome, analysis, row| {
        let name = |condition: usize| outcome.plan.conditions[condition].name.clone();
        analysis.cohen_d.iter().try_for_each(|&(a, b, d)| row(vec![name(a), name(b), optional(d)]))
    })
}

fn tukey(outcome: &Outcome) -> csv::Result<Vec<u8>> {
    let columns = ["measure", "group1", "group2", "meandiff", "p_adj", "lower", "upper", "reject"];
    long(outcome, &columns, |_, analysis, row| {
        analysis.tukey.iter().try_for_each(|pair| {
            let figures = [Some(pair.meandiff), pair.p_adj, pair.lower, pair.upper].map(optional);
            let reject = pair.reject.map(|reject| reject.to_string()).unwrap_or_default();
            row([pair.group1.clone(), pair.group2.clone()].into_iter().chain(figures).chain([reject]).collect())
        })
    })
}

/// Takes a row.
type Row<'a> = dyn FnMut(Vec<String>) -> csv::Result<()> + 'a;

/// A table with rows for each analysis, which open with the measure.
fn long(
    outcome: &Outcome,
    columns: &[&str],
    rows: impl Fn(&Outcome, &Analysis, &mut Row<'_>) -> csv::Result<()>,
) -> csv::Result<Vec<u8>> {
    let mut table = Table::new(outcome);
    table.head([], columns.iter().map(|&column| column.to_owned()))?;
    for analysis in &outcome.analyses {
        let measure = &outcome.measures[analysis.measure];
        rows(outcome, analysis, &mut |fields| {
            table.row([], analysis.paint, [measure.clone()].into_iter().chain(fields))
        })?;
    }
    table.finish()
}

/// A table under way. Where there are several paints, a column between the first columns and the rest says which.
struct Table<'a> {
    paints: &'a [String],
    writer: csv::Writer<Vec<u8>>,
}

impl<'a> Table<'a> {
    fn new(outcome: &'a Outcome) -> Self {
        Self { paints: &outcome.paints, writer: csv::Writer::from_writer(Vec::new()) }
    }

    fn head(
        &mut self,
        first: impl IntoIterator<Item = String>,
        rest: impl IntoIterator<Item = String>,
    ) -> csv::Result<()> {
        let paint = (self.paints.len() > 1).then(|| PAINT.to_owned());
        self.writer.write_record(first.into_iter().chain(paint).chain(rest))
    }

    fn row(
        &mut self,
        first: impl IntoIterator<Item = String>,
        paint: usize,
        rest: impl IntoIterator<Item = String>,
    ) -> csv::Result<()> {
        let paint = (self.paints.len() > 1).then(|| self.paints[paint].clone());
        self.writer.write_record(first.into_iter().chain(paint).chain(rest))
    }

    fn finish(self) -> csv::Result<Vec<u8>> {
        self.writer.into_inner().map_err(|error| error.into_error().into())
    }
}

/// A number with the fewest digits that give it back.
#[must_use]
pub fn number(value: f64) -> String {
    match value.abs() {
        // Nothing is the same on both sides of zero.
        0.0 => "0".to_owned(),
        size if (1e-5..1e16).contains(&size) => format!("{value}"),
        _ => format!("{value:e}"),
    }
}

fn optional(value: Option<f64>) -> String {
    value.map(number).unwrap_or_default()
}
