//! Where texts lie, and what is wrong with each: diagnostics of all looks, put together file by file.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use lsp_types::{Diagnostic, Location, Range, Uri};
use serde_json::json;

use crate::diag;
use crate::library::{MANIFEST, Manifest};
use crate::lsp::{Text, problem};
use crate::span::{SourceId, Sources, Span, Syntax};

use super::super::address;
use super::super::worker::Looked;
use super::Server;

impl Server {
    // ------------------------------------------------------------------------------------------- places

    /// The address of a text of a scene. The text of a standard library is written to a file that can be read.
    fn uri(&mut self, looked: &Looked, source: SourceId) -> Option<Uri> {
        if let Some(path) = looked.place(source) {
            return self.uri_of(path);
        }
        let source = looked.analysis.sources.get(source);
        let name = source.name.strip_prefix("std:")?;
        if !name.chars().all(char::is_alphanumeric) {
            return None;
        }
        let folder = match &self.standard {
            Some(folder) => folder,
            None => self.standard.insert(tempfile::Builder::new().prefix("kake-std-").tempdir().ok()?),
        };
        let path = folder.path().join(format!("{name}.kake"));
        if !path.is_file() {
            fs::write(&path, source.text.as_bytes()).ok()?;
            let mut permissions = fs::metadata(&path).ok()?.permissions();
            permissions.set_readonly(true);
            fs::set_permissions(&path, permissions).ok()?;
        }
        address::uri(&path)
    }

    fn uri_of(&self, path: &Path) -> Option<Uri> {
        let open = self.buffers.values().find(|buffer| buffer.path == path);
        open.map(|buffer| buffer.uri.clone()).or_else(|| address::uri(path))
    }

    pub(super) fn location(&mut self, looked: &Looked, span: Span) -> Option<Location> {
        let uri = self.uri(looked, span.source)?;
        Some(Location { uri, range: self.range(&looked.analysis.sources, span) })
    }

    fn range(&self, sources: &Sources, span: Span) -> Range {
        let text = Text::new(Arc::clone(&sources.get(span.source).text), self.client.encoding);
        text.range(span.start as usize..span.end as usize)
    }

    // ------------------------------------------------------------------------------------------- diagnostics

    /// What is wrong with a scene, by the address of the text that it stands in.
    pub(super) fn problems(&self, key: &str, looked: &Looked) -> BTreeMap<String, Vec<Diagnostic>> {
        let sources = &looked.analysis.sources;
        let texts: BTreeMap<SourceId, (Uri, Text)> = sources
            .iter()
            .filter_map(|(id, source)| {
                let uri = self.uri_of(looked.place(id)?)?;
                Some((id, (uri, Text::new(Arc::clone(&source.text), self.client.encoding))))
            })
            .collect();
        let mut found = self.converted(key, &looked.analysis.diagnostics, &texts);
        found.entry(key.to_owned()).or_default();
        if let Some((path, diagnostics, sources)) = &looked.faults
            && let Some(uri) = self.uri_of(path)
        {
            // The first text is the manifest of the scene's own library.
            let texts = sources
                .iter()
                .take(1)
                .map(|(id, source)| (id, (uri.clone(), Text::new(Arc::clone(&source.text), self.client.encoding))));
            for (uri, list) in self.converted(key, diagnostics, &texts.collect()) {
                found.entry(uri).or_default().extend(list);
            }
        }
        found
    }

    fn converted(
        &self,
        key: &str,
        diagnostics: &[diag::Diagnostic],
        texts: &BTreeMap<SourceId, (Uri, Text)>,
    ) -> BTreeMap<String, Vec<Diagnostic>> {
        let place = |span: Span| {
            let (uri, text) = texts.get(&span.source)?;
            Some(Location { uri: uri.clone(), range: text.range(span.start as usize..span.end as usize) })
        };
        let mut found: BTreeMap<String, Vec<Diagnostic>> = BTreeMap::new();
        let Some(buffer) = self.buffers.get(key) else { return found };
        for diagnostic in diagnostics {
            // What stands in no text that can be opened is told at the scene's beginning.
            let beginning = || Location { uri: buffer.uri.clone(), range: Range::default() };
            let Location { uri, range } = diagnostic.span.and_then(place).unwrap_or_else(beginning);
            let told = problem(diagnostic, (&uri, range), self.client.related, &place);
            found.entry(uri.as_str().to_owned()).or_default().push(told);
        }
        found
    }

    /// What is wrong with a library's manifest.
    pub(super) fn manifest(&self, key: &str) -> Vec<Diagnostic> {
        let Some(buffer) = self.buffers.get(key) else { return Vec::new() };
        let mut sources = Sources::new();
        let source = sources.add(MANIFEST, Arc::clone(buffer.text.shared()), Syntax::Toml);
        let (_, diagnostics) = Manifest::parse(source, buffer.text.as_str());
        let texts = BTreeMap::from([(source, (buffer.uri.clone(), buffer.text.clone()))]);
        self.converted(key, &diagnostics, &texts).into_values().flatten().collect()
    }

    /// Tells the editor what is wrong, file by file, and takes back what is so no longer.
    /// Of the text that was looked at just now something is told in any case.
    pub(super) fn publish(&mut self, fresh: Option<&str>) {
        let mut all: BTreeMap<String, Vec<Diagnostic>> = BTreeMap::new();
        for (uri, list) in self.found.values().flatten() {
            let told = all.entry(uri.clone()).or_default();
            for diagnostic in list {
                // Two scenes that import one file find the same there.
                if !told.contains(diagnostic) {
                    told.push(diagnostic.clone());
                }
            }
        }
        for uri in self.told.keys() {
            all.entry(uri.clone()).or_default();
        }
        for (uri, diagnostics) in all {
            let is_open = self.buffers.contains_key(&uri);
            // An empty list says of an open text that it was looked at, and is not kept for others.
            let is_news = self.told.get(&uri) != Some(&diagnostics);
            match diagnostics.is_empty() && !is_open {
                true => self.told.remove(&uri),
                false => self.told.insert(uri.clone(), diagnostics.clone()),
            };
            if is_news || fresh == Some(uri.as_str()) {
                let mut params = json!({ "uri": uri, "diagnostics": diagnostics });
                if let (Some(version), Some(params)) =
                    (self.buffers.get(&uri).map(|b| b.version), params.as_object_mut())
                {
                    params.insert("version".to_owned(), json!(version));
                }
                self.notify("textDocument/publishDiagnostics", params);
            }
        }
    }
}
