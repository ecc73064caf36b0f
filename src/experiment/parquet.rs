//! The runs as Parquet, with the columns of `runs.csv`, typed.
//!
//! Parameters that are numbers are doubles, those that are true or false booleans, all others text; the seed is an
//! unsigned integer of 64 bits, tiles and edges are integers, every other measure is a double that may be null. The bytes
//! depend on the runs alone.

use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::Result;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;

use super::Outcome;
use super::tables::PAINT;

/// Runs of one group of rows.
const GROUP: usize = 1 << 16;

/// The measures that count something.
const COUNTS: [&str; 2] = ["tiles", "edges"];

/// What a column holds, one value or none a row.
enum Column {
    Text(Vec<String>),
    Number(Vec<Option<f64>>),
    Count(Vec<Option<i64>>),
    Seed(Vec<u64>),
    Bool(Vec<bool>),
}

/// The runs as a Parquet file.
///
/// # Errors
/// If the file cannot be put together, which memory alone could be the reason for.
pub fn runs(outcome: &Outcome) -> Result<Vec<u8>> {
    let columns = columns(outcome);
    let fields: Vec<Arc<Type>> =
        columns.iter().map(|(name, column)| column.field(name).map(Arc::new)).collect::<Result<_>>()?;
    let schema = Arc::new(Type::group_type_builder("runs").with_fields(fields).build()?);
    let by = format!("kake version {}", env!("CARGO_PKG_VERSION"));
    let properties = Arc::new(WriterProperties::builder().set_created_by(by).build());
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, properties)?;
    let rows = outcome.runs.len();
    for start in (0..rows).step_by(GROUP) {
        let mut group = writer.next_row_group()?;
        for (_, column) in &columns {
            column.write(&mut group, start..rows.min(start + GROUP))?;
        }
        group.close()?;
    }
    writer.close()?;
    Ok(bytes)
}

/// The columns by their names, in the order of `runs.csv`.
fn columns(outcome: &Outcome) -> Vec<(String, Column)> {
    let runs = &outcome.runs;
    let mut columns = Vec::new();
    for (i, param) in outcome.plan.params.iter().enumerate() {
        let labels = || runs.iter().map(|run| outcome.plan.conditions[run.condition].labels[i].clone());
        columns.push((
            param.name.clone(),
            match param.ty.as_str() {
                "number" => Column::Number(labels().map(|label| label.parse().ok()).collect()),
                "bool" => Column::Bool(labels().map(|label| label == "true").collect()),
                _ => Column::Text(labels().collect()),
            },
        ));
    }
    columns.push(("seed".to_owned(), Column::Seed(runs.iter().map(|run| run.seed).collect())));
    if outcome.paints.len() > 1 {
        let paints = runs.iter().map(|run| outcome.paints[run.paint].clone());
        columns.push((PAINT.to_owned(), Column::Text(paints.collect())));
    }
    for (i, measure) in outcome.measures.iter().enumerate() {
        let values = runs.iter().map(|run| run.values[i]);
        columns.push((
            measure.clone(),
            match COUNTS.contains(&measure.as_str()) {
                true => Column::Count(values.map(|value| value.map(|value| value as i64)).collect()),
                false => Column::Number(values.collect()),
            },
        ));
    }
    columns
}

impl Column {
    fn field(&self, name: &str) -> Result<Type> {
        let (physical, logical, repetition) = match self {
            Self::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::REQUIRED),
            Self::Number(_) => (Physical::DOUBLE, None, Repetition::OPTIONAL),
            Self::Count(_) => (Physical::INT64, None, Repetition::OPTIONAL),
            Self::Seed(_) => {
                let unsigned = LogicalType::integer(64, false);
                (Physical::INT64, Some(unsigned), Repetition::REQUIRED)
            }
            Self::Bool(_) => (Physical::BOOLEAN, None, Repetition::REQUIRED),
        };
        Type::primitive_type_builder(name, physical).with_logical_type(logical).with_repetition(repetition).build()
    }

    fn write(
        &self,
        group: &mut SerializedRowGroupWriter<'_, &mut Vec<u8>>,
        rows: std::ops::Range<usize>,
    ) -> Result<()> {
        let Some(mut column) = group.next_column()? else { return Ok(()) };
        match self {
            Self::Text(texts) => {
                let texts: Vec<ByteArray> = texts[rows].iter().map(|text| text.as_str().into()).collect();
                column.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
            }
            Self::Number(values) => {
                let (values, levels) = split(&values[rows]);
                column.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
            }
            Self::Count(values) => {
                let (values, levels) = split(&values[rows]);
                column.typed::<Int64Type>().write_batch(&values, Some(&levels), None)?;
            }
            Self::Seed(seeds) => {
                let seeds: Vec<i64> = seeds[rows].iter().map(|seed| seed.cast_signed()).collect();
                column.typed::<Int64Type>().write_batch(&seeds, None, None)?;
            }
            Self::Bool(values) => {
                column.typed::<BoolType>().write_batch(&values[rows], None, None)?;
            }
        }
        column.close()
    }
}

/// The values that are there, and for every row whether it has one.
fn split<T: Copy>(values: &[Option<T>]) -> (Vec<T>, Vec<i16>) {
    (values.iter().flatten().copied().collect(), values.iter().map(|value| i16::from(value.is_some())).collect())
}
