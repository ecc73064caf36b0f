//! Batches: the same scene with different seeds and parameters, on all cores, and all of it on one sheet.
//!
//! Every combination of parameters is lowered first, so that a value that is refused is said before anything is drawn. Then
//! pictures are made in parallel, a bounded number at a time; one that is at fault leaves the others alone. What is told does
//! not depend on the order in which they happen to be ready.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::cli::files::Opened;
use crate::cli::progress::{Bar, Progress};
use crate::cli::{Ended, report};
use crate::diag::Diagnostic;
use crate::geom::Length;
use crate::lower::lower;

use super::job::{Done, Job};
use super::output::{expanded, safe, same_file};
use super::vary::{Cell, NUMBER, Vary, axes, cells};
use super::{BuildArgs, Kind, asked, kind_of};

mod sheet;

use sheet::Sheeted;

/// Pixels that are held in memory at a time by all pictures that are made.
const MOST_PIXELS: u64 = 256_000_000;

/// How many pictures at fault are named.
const NAMED: usize = 8;

/// The files of every picture, with their kinds.
type Outputs = Vec<Vec<(PathBuf, Kind)>>;

/// What lowering says of a picture before it is drawn.
#[derive(Debug, Clone)]
enum Expected {
    /// Its width and height, and its pixels.
    Page([Length; 2], u64),
    /// It has no page that anybody has asked for, and will be found at fault.
    Unknown,
}

/// What is refused of a value on the command line: in short, by which it is told apart, and as it is shown.
#[derive(Debug, Clone)]
struct Refusal {
    of: String,
    words: String,
}

pub(super) fn run(arguments: &BuildArgs, opened: &Opened) -> Ended {
    let has_seed = arguments.seeds.is_some();
    let axes = axes(arguments);
    let cells = cells(&axes, has_seed);
    let outputs = match outputs(arguments, &axes, &cells) {
        Ok(outputs) => outputs,
        Err(words) => {
            eprintln!("kake: {words}");
            return Ended::Usage;
        }
    };
    let batch = Batch { arguments, opened, axes: &axes, cells: &cells, outputs };
    let expected = match batch.expected() {
        Ok(expected) => expected,
        Err(words) => {
            eprint!("{words}");
            return Ended::Fault;
        }
    };
    let sheet = match &arguments.sheet {
        Some(file) => match Sheeted::new(&batch, file, &expected) {
            Ok(sheet) => Some(sheet),
            Err(words) => {
                eprintln!("kake: {words}");
                return Ended::Fault;
            }
        },
        None => None,
    };
    let begun = Instant::now();
    let made = batch.make(&expected, sheet.as_ref());
    let mut ended = batch.tell(&made.cells);
    if let Some(sheet) = sheet
        && ended != Ended::Io
    {
        let written = sheet.write();
        ended = if ended == Ended::Done || written == Ended::Io { written } else { ended };
    }
    if arguments.timings {
        let mut spent = made.spent;
        spent.push(("total".to_owned(), begun.elapsed()));
        report::timings(&spent);
    }
    ended
}

/// A batch that is ready to be made.
struct Batch<'a> {
    arguments: &'a BuildArgs,
    opened: &'a Opened,
    axes: &'a [Vary],
    cells: &'a [Cell],
    outputs: Outputs,
}

/// What came of a picture: what is to be told, and how it ended. Nothing where it was not begun.
type Told = Option<(String, Ended)>;

/// What was spent on each step.
type Spent = Vec<(String, Duration)>;

/// What came of all pictures.
struct Made {
    cells: Vec<Told>,
    /// All pictures together.
    spent: Spent,
}

impl Batch<'_> {
    fn job(&self, cell: usize) -> Job<'_> {
        let of = &self.cells[cell];
        let seed = of.seed().or(self.arguments.seed);
        Job::new(self.arguments, self.opened, (seed, of.sets()), self.outputs[cell].clone())
    }

    /// What every picture will be, or why there is no point in beginning: a parameter that the scene does not have, or a
    /// value that it refuses.
    fn expected(&self) -> Result<Vec<Expected>, String> {
        let seeds = self.arguments.seeds.and(self.axes.last()).map_or(1, |seeds| seeds.values.len());
        // The page does not depend on the seed.
        let combinations = self.cells.len() / seeds.max(1);
        let found = Mutex::new(vec![(Expected::Unknown, Vec::new()); combinations]);
        in_parallel(combinations, self.threads(), &|i| {
            let job = self.job(i * seeds);
            let lowered = lower(&self.opened.path, &self.opened.loader, &job.config.lower);
            let expected = match &lowered.scene {
                Some(scene) => {
                    let canvas = &scene.canvas;
                    let pixels = canvas.pixels.map(u64::from);
                    Expected::Page([canvas.width, canvas.height], pixels[0].saturating_mul(pixels[1]))
                }
                None => Expected::Unknown,
            };
            // What stands in a value that the command line gives is refused for all pictures that have it.
            let refusal = |diagnostic: &Diagnostic| {
                let source = lowered.sources.get(diagnostic.span?.source);
                let is_set = diagnostic.is_error() && source.name.starts_with("--");
                let words = || report::words(std::slice::from_ref(diagnostic), &lowered.sources);
                is_set.then(|| Refusal { of: format!("{} {}", source.name, diagnostic.message), words: words() })
            };
            lock(&found)[i] = (expected, lowered.diagnostics.iter().filter_map(refusal).collect());
            true
        });
        let found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut said: Vec<&Refusal> = Vec::new();
        for refusal in found.iter().flat_map(|(_, refused)| refused) {
            if said.iter().all(|known| known.of != refusal.of) {
                said.push(refusal);
            }
        }
        match said.is_empty() {
            true => Ok((0..self.cells.len()).map(|cell| found[cell / seeds.max(1)].0.clone()).collect()),
            false => Err(said.into_iter().map(|refusal| refusal.words.as_str()).collect()),
        }
    }

    /// How many pictures are made at a time.
    fn threads(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        self.arguments.threads.map_or_else(cores, usize::from)
    }

    /// Makes every picture.
    fn make(&self, expected: &[Expected], sheet: Option<&Sheeted>) -> Made {
        let is_raster = self.outputs.iter().flatten().any(|(_, kind)| *kind == Kind::Png);
        let largest = expected.iter().filter(|_| is_raster).map(|expected| match expected {
            Expected::Page(_, pixels) => *pixels,
            Expected::Unknown => 0,
        });
        let room = (MOST_PIXELS / largest.max().unwrap_or(0).max(1)).max(1);
        let threads = self.threads().min(usize::try_from(room).unwrap_or(usize::MAX));
        let bar = Bar::new("pictures", self.cells.len(), 0);
        let made: Mutex<Vec<Option<(Told, Spent)>>> = Mutex::new(vec![None; self.cells.len()]);
        in_parallel(self.cells.len(), threads, &|cell| {
            let mut progress = Progress::unseen();
            let Done { words, ended, drawing } = self.job(cell).run(&mut progress);
            if let (Some(sheet), Some(drawing)) = (sheet, drawing) {
                progress.step("sheet", "");
                sheet.put(cell, drawing);
            }
            lock(&made)[cell] = Some((Some((words, ended)), progress.finish()));
            bar.advance();
            // Where one file cannot be written, the next hardly can.
            ended != Ended::Io
        });
        bar.finish();
        let made = made.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut spent = Spent::new();
        let steps = made.iter().flatten().flat_map(|(_, spent)| spent).filter(|(name, _)| name != "total");
        for (name, step) in steps {
            match spent.iter_mut().find(|(known, _)| known == name) {
                Some((_, sum)) => *sum += *step,
                None => spent.push((name.clone(), *step)),
            }
        }
        Made { cells: made.into_iter().map(|made| made.and_then(|(told, _)| told)).collect(), spent }
    }

    /// Says what there is to say, what several pictures say once; and which are at fault.
    fn tell(&self, made: &[Told]) -> Ended {
        let mut said: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (cell, told) in made.iter().enumerate() {
            if let Some((words, _)) = told.as_ref().filter(|(words, _)| !words.is_empty()) {
                said.entry(words).or_default().push(cell);
            }
        }
        let mut said: Vec<(&str, Vec<usize>)> = said.into_iter().collect();
        said.sort_by_key(|(_, cells)| cells.first().copied());
        for (words, cells) in said {
            // What all pictures say is no matter of what varies.
            if cells.len() < self.cells.len() {
                eprintln!("kake: {}:", self.names(&cells));
            }
            eprint!("{words}");
        }
        let ended = |wanted: Ended| -> Vec<usize> {
            let of = |told: &Told| told.as_ref().is_some_and(|(_, ended)| *ended == wanted);
            made.iter().enumerate().filter(|(_, told)| of(told)).map(|(cell, _)| cell).collect()
        };
        let (faults, unwritten) = (ended(Ended::Fault), ended(Ended::Io));
        if !faults.is_empty() && self.cells.len() > 1 {
            let all = self.cells.len();
            eprintln!("kake: {} of {all} pictures could not be made: {}", faults.len(), self.names(&faults));
        }
        if !unwritten.is_empty() {
            let left = made.iter().filter(|told| told.is_none()).count();
            if left > 0 {
                eprintln!("kake: {left} of {} pictures were not begun", self.cells.len());
            }
            return Ended::Io;
        }
        if faults.is_empty() { Ended::Done } else { Ended::Fault }
    }

    /// The names of pictures, the first few of many.
    fn names(&self, cells: &[usize]) -> String {
        let names: Vec<String> = cells.iter().take(NAMED).map(|&cell| self.cells[cell].name()).collect();
        let more = match cells.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!("; and {more} more"),
        };
        names.join("; ") + &more
    }
}

fn lock<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does `work` for every number below `count`, so many at a time, lower numbers first, until it says that there is no
/// point in going on. The threads are not those of the pool that single pictures are drawn by: one that waits there takes
/// up further work, and more pictures would be begun than there is room for.
fn in_parallel(count: usize, threads: usize, work: &(dyn Fn(usize) -> bool + Sync)) {
    let (next, goes_on) = (AtomicUsize::new(0), AtomicBool::new(true));
    let worker = || {
        while goes_on.load(Ordering::Relaxed) {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= count {
                break;
            }
            if !work(number) {
                goes_on.store(false, Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.min(count) {
            // Where no further thread can be had, those that there are do it all.
            if std::thread::Builder::new().spawn_scoped(scope, worker).is_err() {
                break;
            }
        }
        worker();
    });
}

/// The files of every picture. Two of one name are refused, and folders that are not there.
fn outputs(arguments: &BuildArgs, axes: &[Vary], cells: &[Cell]) -> Result<Outputs, String> {
    let asked = asked(arguments);
    let digits = cells.len().to_string().len();
    let mut outputs = Outputs::new();
    // Some file systems know no capitals: what is one file there is one file everywhere.
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    for (i, cell) in cells.iter().enumerate() {
        let value = |name: &str| match cell.values.iter().find(|(known, _)| known == name) {
            Some((_, value)) => Some(safe(value)),
            None if name == NUMBER => Some(format!("{:0digits$}", i + 1)),
            None if name == super::vary::SEED => arguments.seed.map(|seed| seed.to_string()),
            None => None,
        };
        let mut files = Vec::new();
        for output in &asked {
            if cells.len() > 1 && output.as_os_str() == "-" {
                return Err("several pictures need files: standard output takes one".to_owned());
            }
            let file = expanded(output, &value).map_err(|name| unknown(output, &name, axes))?;
            if let Some(&other) = taken.get(&file.to_string_lossy().to_lowercase()) {
                return Err(clash(output, [&cells[other], cell], axes));
            }
            taken.insert(file.to_string_lossy().to_lowercase(), i);
            check_place(&file, &arguments.scene.scene)?;
            files.push((file, kind_of(output)?));
        }
        outputs.push(files);
    }
    if let Some(sheet) = &arguments.sheet {
        if taken.contains_key(&sheet.to_string_lossy().to_lowercase()) {
            return Err(format!("{} is a picture and the sheet", sheet.display()));
        }
        check_place(sheet, &arguments.scene.scene)?;
    }
    Ok(outputs)
}

/// A place that nothing can be written to.
fn check_place(file: &Path, scene: &Path) -> Result<(), String> {
    if same_file(file, scene) {
        return Err(format!("{} is the scene itself", file.display()));
    }
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.exists() => {
            Err(format!("{}: there is no folder {}", file.display(), folder.display()))
        }
        _ => Ok(()),
    }
}

fn unknown(output: &Path, name: &str, axes: &[Vary]) -> String {
    // Which of the two is the slip is not known: the name of the output, or that of what varies.
    let known = axes.iter().map(|axis| axis.name.as_str()).chain([NUMBER]);
    let listed: Vec<String> = known.map(|name| format!("{{{name}}}")).collect();
    format!("{}: nothing that varies is called `{name}`; there are {}", output.display(), listed.join(", "))
}

fn clash(output: &Path, [first, second]: [&Cell; 2], axes: &[Vary]) -> String {
    let differs = first.values.iter().zip(&second.values).filter(|(a, b)| a != b).map(|((name, _), _)| name.clone());
    let lacking: Vec<String> = differs
        .filter(|name| axes.iter().any(|axis| axis.name == *name))
        .map(|name| format!("{{{name}}}"))
        .filter(|name| !output.to_string_lossy().contains(name.as_str()))
        .collect();
    match lacking.as_slice() {
        [] => format!(
            "{}: `{}` and `{}` would be one file; put {{n}} into the name, which numbers the pictures",
            output.display(),
            first.name(),
            second.name()
        ),
        names => format!("{}: several pictures need {} in the name, or {{n}}", output.display(), names.join(" and ")),
    }
}
