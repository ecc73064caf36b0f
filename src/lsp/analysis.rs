//! One scene as lowering sees it, and questions about its names.
//!
//! In: the path of a scene and a loader, in which texts that are being written stand in for files. Out: the diagnostics,
//! and for every name of every file what it means.

use std::collections::BTreeMap;

use crate::diag::Diagnostic;
use crate::loader::Loader;
use crate::lower::reference::{Kind, Slot};
use crate::lower::{self, LowerConfig, Survey, Worth};
use crate::scene::Limits;
use crate::span::{SourceId, Sources, Span};
use crate::stop::Stop;
use crate::syntax::ast::{Document, StatementKind};

use super::context::Known;
use super::declared::{Declared, declared, kind_of};
use super::frame::Called;

/// A scene that was looked at.
#[derive(Debug)]
pub struct Analysis {
    /// Every text, the scene's own first; none where it could not be read.
    pub sources: Sources,
    /// What is wrong.
    pub diagnostics: Vec<Diagnostic>,
    /// What names mean.
    pub survey: Survey,
    /// The files that the scene reads besides, by their paths.
    pub files: Vec<String>,
}

/// A place in one of the texts.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// The text.
    pub source: SourceId,
    /// A byte of it.
    pub offset: usize,
}

impl Analysis {
    /// Looks at the scene at `path`. With `stop` asked, what comes back is of no use.
    #[must_use]
    pub fn new(path: &str, loader: &dyn Loader, stop: Stop) -> Self {
        let config = LowerConfig { limits: Limits { stop, ..Limits::default() }, ..LowerConfig::default() };
        let (lowered, survey) = lower::survey(path, loader, &config);
        let files = lowered.files.into_keys().collect();
        Self { sources: lowered.sources, diagnostics: lowered.diagnostics, survey, files }
    }

    /// The text of a name as messages call it.
    #[must_use]
    pub fn source(&self, name: &str) -> Option<SourceId> {
        self.sources.iter().find(|(_, source)| source.name == name).map(|(id, _)| id)
    }

    /// The document of a text.
    #[must_use]
    pub fn document(&self, source: SourceId) -> Option<&Document> {
        self.survey.documents.iter().find(|document| document.source == source)
    }

    /// The name at a place, and where it is declared.
    #[must_use]
    pub fn name_at(&self, spot: Spot) -> Option<(Span, Span)> {
        let used = at(&self.survey.uses, spot).map(|(used, declared)| (used, *declared));
        used.or_else(|| {
            let document = self.document(spot.source)?;
            let declared = declared(document).into_iter().find(|declared| touches(declared.name.span, spot))?;
            Some((declared.name.span, declared.name.span))
        })
    }

    /// The import whose path stands at a place, with the text that it names.
    #[must_use]
    pub fn import_at(&self, spot: Spot) -> Option<(Span, SourceId)> {
        at(&self.survey.imports, spot).map(|(span, source)| (span, *source))
    }

    /// What is declared at the place of a name.
    #[must_use]
    pub fn declaration(&self, name: Span) -> Option<Declared<'_>> {
        let document = self.document(name.source)?;
        declared(document).into_iter().find(|declared| declared.name.span == name)
    }

    /// Every place that names what is declared at `name`, in order, the declaration among them.
    #[must_use]
    pub fn places_of(&self, name: Span) -> Vec<Span> {
        let uses = self.survey.uses.iter().filter(|(_, declared)| **declared == name).map(|(used, _)| *used);
        let mut places: Vec<Span> = uses.chain([name]).collect();
        places.sort();
        places.dedup();
        places
    }

    /// What a declaration is worth.
    #[must_use]
    pub fn worth(&self, name: Span) -> Option<&Worth> {
        self.survey.values.get(&name)
    }

    /// The texts whose names a text sees as they are: itself, then what it imports without `as`.
    fn seen_from(&self, source: SourceId) -> Vec<SourceId> {
        let mut seen = vec![source];
        seen.extend(self.imports(source).into_iter().filter(|(alias, _)| alias.is_none()).map(|(_, id)| id));
        seen
    }

    /// What a text imports, with the names of the modules.
    #[must_use]
    pub fn imports(&self, source: SourceId) -> Vec<(Option<&str>, SourceId)> {
        let statements = self.document(source).map(|document| document.statements.iter()).into_iter().flatten();
        let imports = statements.filter_map(|statement| match &statement.kind {
            StatementKind::Import { path, alias } => {
                let target = self.survey.imports.get(&path.span)?;
                Some((alias.as_ref().map(|alias| alias.name.as_str()), *target))
            }
            _ => None,
        });
        imports.collect()
    }

    /// What the top levels declare that a text sees without a module's name.
    #[must_use]
    pub fn visible(&self, source: SourceId) -> Vec<Declared<'_>> {
        let documents = self.seen_from(source).into_iter().filter_map(|source| self.document(source));
        documents.flat_map(declared).filter(|declared| declared.is_top).collect()
    }

    /// What a module declares, by the name that a text gives it.
    #[must_use]
    pub fn members(&self, source: SourceId, module: &str) -> Vec<Declared<'_>> {
        let imports = self.imports(source).into_iter().filter(|(alias, _)| *alias == Some(module));
        let documents = imports.filter_map(|(_, source)| self.document(source));
        documents.flat_map(declared).filter(|declared| declared.is_top).collect()
    }

    /// What a call names: a tone where one is asked for, else a function, else a tone.
    #[must_use]
    pub fn called(&self, source: SourceId, called: &Called<'_>, slot: Slot) -> Option<Declared<'_>> {
        let candidates = match called.module {
            Some(module) => self.members(source, module),
            None => self.visible(source),
        };
        let named = candidates.into_iter().filter(|declared| declared.name.name == called.name);
        let mut callable: Vec<_> = named.filter(|declared| declared.parameters().is_some()).collect();
        let wants_tone = slot.kind == Some(Kind::Tone);
        callable.sort_by_key(|declared| (declared.noun() == "tone") != wants_tone);
        let first = callable.into_iter().next()?;
        // Tones are called only where one is asked for, or by a module's name.
        (wants_tone || called.module.is_some() || first.noun() == "function").then_some(first)
    }

    /// The kind of a declared value, as far as it is known.
    #[must_use]
    pub fn kind(&self, declared: &Declared<'_>) -> Option<Kind> {
        self.worth(declared.name.span).and_then(|worth| worth.kind)
    }
}

/// What is known of a file that is being written.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// Its scene as it was looked at last.
    pub analysis: &'a Analysis,
    /// The file in it.
    pub source: SourceId,
}

impl Known for Seen<'_> {
    fn parameters(&self, called: &Called<'_>, slot: Slot) -> Option<Vec<(String, Slot)>> {
        let declared = self.analysis.called(self.source, called, slot)?;
        let params = declared.parameters()?.iter().map(|param| {
            let worth = self.analysis.worth(param.name.span).and_then(|worth| worth.kind);
            let kind = kind_of(param).or(worth);
            (param.name.name.clone(), kind.map_or(Slot::ANY, Slot::of))
        });
        Some(params.collect())
    }
}

/// The entry of the span that a place lies in or directly behind; the narrowest of several.
fn at<T>(map: &BTreeMap<Span, T>, spot: Spot) -> Option<(Span, &T)> {
    let upto = Span::new(spot.source, spot.offset, spot.offset);
    let upto = Span { end: u32::MAX, ..upto };
    // Names do not lie within each other, but a string holds those of its interpolations.
    let near = map.range(..=upto).rev().take_while(|(span, _)| span.source == spot.source).take(64);
    let touching = near.filter(|(span, _)| touches(**span, spot));
    touching.min_by_key(|(span, _)| span.end - span.start).map(|(span, value)| (*span, value))
}

/// Whether a place lies in a span or directly behind it.
#[must_use]
pub fn touches(span: Span, spot: Spot) -> bool {
    let offset = u32::try_from(spot.offset).unwrap_or(u32::MAX);
    span.source == spot.source && span.start <= offset && offset <= span.end
}
