//! What lowering carries along: the modules, what was found at fault, counts that are limited, files that were read.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

use crate::diag::{Code, Diagnostic, grouped};
use crate::field::Image;
use crate::geom::{Length, Period};
use crate::loader::Loader;
use crate::region::Region;
use crate::region::svg::SvgFile;
use crate::span::{SourceId, Span};

use super::LowerConfig;
use super::modules::Module;
use super::params;
use super::survey::Survey;
use super::value::Value;

/// How deep evaluation may go before the stack is at risk. The thread that lowers has room for it.
const DEPTH: u32 = 10_000;

/// How many mistakes are reported.
const MOST_REPORTED: usize = 1000;

/// How many mistakes are reported with near names.
const MOST_HINTED: usize = 200;

/// The state of lowering. `'a` is the life of the documents.
pub(super) struct Cx<'a, 'c> {
    pub(super) modules: &'c [Module<'a>],
    pub(super) config: &'c LowerConfig,
    pub(super) loader: &'c dyn Loader,
    pub(super) seed: u64,
    /// One canvas unit in millimetres.
    pub(super) unit: f64,
    /// Pixels per inch, once the canvas is known.
    pub(super) dpi: Option<f64>,
    /// The page, once it is known.
    pub(super) page: Option<Region>,
    /// The period of a page that repeats.
    pub(super) period: Option<Period>,
    /// How far ink spreads, and where that is said.
    pub(super) gain: Option<(Length, Span)>,
    /// Values that were set, by module and name.
    pub(super) set: BTreeMap<(usize, String), &'a params::Set>,
    /// Parameters that have their values, by module and name.
    pub(super) settled: BTreeMap<(usize, String), params::Settled>,
    /// The choices of parameters, by module and name.
    pub(super) choices: BTreeMap<(usize, String), Vec<Value>>,
    /// The names that fields are called after while they are evaluated, with a count of the noises in each.
    pub(super) naming: Vec<(String, u32)>,
    pub(super) images: BTreeMap<(String, &'static str), Option<Arc<Image>>>,
    /// Blurred images by the address of the image and how much it was blurred, with the image itself.
    pub(super) blurred: BTreeMap<(usize, u64), (Arc<Image>, Arc<Image>)>,
    /// How many pixels were blurred, all images together.
    pub(super) blurred_pixels: u64,
    pub(super) drawings: BTreeMap<String, Option<Rc<SvgFile>>>,
    /// Warnings of tones that lack something, until a paint says so.
    pub(super) lacking: Vec<Diagnostic>,
    /// What is found out about names, where somebody asks.
    pub(super) survey: Option<Box<Survey>>,
    /// Dead branches that were checked already.
    pub(super) checked: BTreeSet<Span>,
    /// Calls of functions, tones and lazy values that are under way.
    calls: u32,
    /// Where the functions and tones that are under way are declared.
    under_way: Vec<Span>,
    /// Those that were found to call each other without end.
    runaway: BTreeSet<Span>,
    files: BTreeMap<String, Arc<[u8]>>,
    diagnostics: Vec<Diagnostic>,
    reported: BTreeSet<(Code, Option<Span>)>,
    dead: u32,
    depth: u32,
    iterations: u64,
    exhausted: bool,
}

impl<'a, 'c> Cx<'a, 'c> {
    pub(super) fn new(
        modules: &'c [Module<'a>],
        loader: &'c dyn Loader,
        config: &'c LowerConfig,
        diagnostics: Vec<Diagnostic>,
    ) -> Self {
        Self {
            modules,
            config,
            loader,
            seed: 0,
            unit: 1.0,
            dpi: None,
            page: None,
            period: None,
            gain: None,
            set: BTreeMap::new(),
            settled: BTreeMap::new(),
            choices: BTreeMap::new(),
            naming: Vec::new(),
            images: BTreeMap::new(),
            blurred: BTreeMap::new(),
            blurred_pixels: 0,
            drawings: BTreeMap::new(),
            lacking: Vec::new(),
            survey: None,
            checked: BTreeSet::new(),
            calls: 0,
            under_way: Vec::new(),
            runaway: BTreeSet::new(),
            files: BTreeMap::new(),
            diagnostics,
            reported: BTreeSet::new(),
            dead: 0,
            depth: 0,
            iterations: 0,
            exhausted: false,
        }
    }

    /// The diagnostics and the files that were read.
    pub(super) fn finish(mut self) -> (Vec<Diagnostic>, BTreeMap<String, Arc<[u8]>>) {
        self.diagnostics.append(&mut self.lacking);
        (self.diagnostics, self.files)
    }

    /// Reports a mistake that is one whatever the values are. A second one of the same kind at the same place says
    /// nothing new.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        if self.reported.len() > MOST_REPORTED || !self.reported.insert((diagnostic.code, diagnostic.span)) {
            return;
        }
        if self.reported.len() > MOST_REPORTED {
            let message = format!("there are more than {MOST_REPORTED} mistakes; the rest are not shown");
            self.diagnostics.push(Diagnostic { message, hint: None, notes: Vec::new(), ..diagnostic });
        } else {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Whether so many mistakes were found that near names are no longer looked for: each takes a walk over all names.
    pub(super) fn is_swamped(&self) -> bool {
        self.reported.len() > MOST_HINTED
    }

    /// Reports a mistake in a value, unless the code is only checked: what never runs has no values.
    pub(super) fn report_value(&mut self, diagnostic: Diagnostic) {
        if self.dead == 0 {
            self.report(diagnostic);
        }
    }

    /// Whether the code at hand is only checked.
    pub(super) fn is_dead(&self) -> bool {
        self.dead > 0
    }

    /// Runs `check` on code that does not run.
    pub(super) fn dead<T>(&mut self, check: impl FnOnce(&mut Self) -> T) -> T {
        self.dead += 1;
        let result = check(self);
        self.dead -= 1;
        result
    }

    /// Runs `check` on code that does not run, unless it was checked before.
    pub(super) fn dead_once<T>(&mut self, span: Span, check: impl FnOnce(&mut Self) -> T) -> Option<T> {
        self.checked.insert(span).then(|| self.dead(check))
    }

    /// Goes one level deeper; `None`, with a diagnostic, where that is too deep.
    pub(super) fn deeper<T>(&mut self, span: Span, inner: impl FnOnce(&mut Self) -> T) -> Option<T> {
        if self.config.limits.stop.is_asked() {
            return None;
        }
        if self.depth >= DEPTH {
            let message = format!("values lead into each other more than {DEPTH} steps deep");
            self.report(Diagnostic::error(Code::Recursion, span, message));
            return None;
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        Some(result)
    }

    /// Enters a call of a function or tone; `None`, with a diagnostic, where calls are nested beyond the limit.
    pub(super) fn nested<T>(&mut self, span: Span, inner: impl FnOnce(&mut Self) -> T) -> Option<T> {
        let limit = self.config.limits.nesting;
        if u64::from(self.calls) >= limit {
            let message = format!("calls are nested more than {limit} deep");
            self.report(
                Diagnostic::error(Code::Recursion, span, message)
                    .hint("what calls itself needs a condition that ends it; `--limit nesting=N` lifts the limit"),
            );
            return None;
        }
        self.calls += 1;
        let result = self.deeper(span, inner);
        self.calls -= 1;
        result
    }

    /// Enters a call of the function or tone that is declared at `name`.
    pub(super) fn called<T>(&mut self, name: Span, span: Span, inner: impl FnOnce(&mut Self) -> T) -> Option<T> {
        self.under_way.push(name);
        let result = self.nested(span, inner);
        if result.is_none() {
            self.give_up();
        }
        self.under_way.pop();
        result
    }

    /// Calls of what is under way now come to nothing from here on: one report of a round of calls is enough.
    pub(super) fn give_up(&mut self) {
        self.runaway.extend(self.under_way.iter().copied());
    }

    /// Whether a function or tone is one of those that call each other without end.
    pub(super) fn is_runaway(&self, name: Span) -> bool {
        self.runaway.contains(&name)
    }

    /// Whether a call of a function or tone is under way.
    pub(super) fn is_under_way(&self, name: Span) -> bool {
        self.under_way.contains(&name)
    }

    /// Finds the value of a declaration. Those of a module are worth the same whoever asks, so they are live even where
    /// the code that asks is only checked.
    pub(super) fn declared<T>(&mut self, span: Span, of_module: bool, inner: impl FnOnce(&mut Self) -> T) -> Option<T> {
        let dead = self.dead;
        if of_module {
            self.dead = 0;
        }
        let result = self.deeper(span, inner);
        self.dead = dead;
        result
    }

    /// Counts a round of a loop or a call; false, with a diagnostic, where there were too many.
    pub(super) fn count_iteration(&mut self, span: Span) -> bool {
        self.iterations += 1;
        let limit = self.config.limits.iterations;
        if self.iterations <= limit {
            return true;
        }
        if !self.exhausted {
            self.exhausted = true;
            let message = format!("the scene runs more than {} rounds of loops and calls", grouped(limit));
            self.report(
                Diagnostic::error(Code::Limit, span, message)
                    .label("the limit was reached here")
                    .hint("`--limit iterations=N` lifts it, if the loop does end"),
            );
        }
        false
    }

    /// One canvas unit.
    pub(super) fn unit_length(&self) -> Length {
        Length::mm(self.unit)
    }

    /// The modules whose names can be seen from one without a prefix: itself, then what it imports without `as`.
    pub(super) fn seen_from(&self, module: usize) -> impl Iterator<Item = &'c Module<'a>> + use<'a, 'c> {
        let modules = self.modules;
        let opened = modules[module].opened.iter().map(move |&opened| &modules[opened]);
        std::iter::once(&modules[module]).chain(opened)
    }

    /// The path of the file that a text stands in; the scene's own for values from the command line.
    pub(super) fn path_of(&self, source: SourceId) -> &'a str {
        let module = self.modules.iter().find(|module| module.document.source == source);
        module.or(self.modules.first()).map_or("", |module| module.path)
    }

    /// A file that was read before.
    pub(super) fn file(&self, path: &str) -> Option<Arc<[u8]>> {
        self.files.get(path).cloned()
    }

    /// Remembers a file that was read.
    pub(super) fn remember_file(&mut self, path: &str, bytes: &Arc<[u8]>) {
        self.files.insert(path.to_owned(), Arc::clone(bytes));
    }
}
