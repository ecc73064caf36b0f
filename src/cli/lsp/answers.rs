//! Requests and their answers: the protocol's parameters in, what [`crate::lsp`] says out.

use std::sync::Arc;

use lsp_server::{ErrorCode, Request, RequestId};
use lsp_types::{
    CodeActionParams, ColorPresentationParams, CompletionParams, DocumentFormattingParams, DocumentHighlight, Hover,
    HoverContents, HoverParams, MarkupContent, MarkupKind, Position, ReferenceParams, RenameParams,
    SignatureHelpParams, TextDocumentPositionParams, TextEdit,
};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::diag::Code;
use crate::lsp::{self, Encoding, Seen, Spot, Text, touches};
use crate::span::{SourceId, Sources, Span, Syntax};
use crate::stop::Stop;
use crate::syntax::ast::Document;
use crate::syntax::{format, kake, toml};

use super::drafts::Beside;
use super::renaming;
use super::server::{Buffer, BufferKind, Client, Refusal, Server, Task};
use super::worker::{Looked, Outcome};

/// The command that explains a code.
const EXPLAIN: &str = "kake.explain";

/// What the server can do.
pub(super) fn capabilities(encoding: Encoding) -> Value {
    json!({
        "positionEncoding": encoding.kind(),
        "textDocumentSync": { "openClose": true, "change": 2, "save": true },
        "completionProvider": { "triggerCharacters": [".", ":", "(", ",", "\"", "/"] },
        "signatureHelpProvider": { "triggerCharacters": ["(", ","], "retriggerCharacters": [":"] },
        "hoverProvider": true,
        "definitionProvider": true,
        "referencesProvider": true,
        "documentHighlightProvider": true,
        "renameProvider": { "prepareProvider": true },
        "documentFormattingProvider": true,
        "documentSymbolProvider": true,
        "foldingRangeProvider": true,
        "colorProvider": true,
        "codeActionProvider": { "codeActionKinds": ["quickfix"] },
        "executeCommandProvider": { "commands": [EXPLAIN] },
    })
}

/// What a request needs to be answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Needs {
    /// The text alone.
    Text,
    /// Some look at the scene.
    Look,
    /// A look at the text as it is.
    Fresh,
}

/// What a request needs.
pub(super) fn needs(method: &str) -> Needs {
    match method {
        "textDocument/completion" | "textDocument/signatureHelp" => Needs::Look,
        "textDocument/hover"
        | "textDocument/definition"
        | "textDocument/references"
        | "textDocument/documentHighlight"
        | "textDocument/prepareRename"
        | "textDocument/rename"
        | "textDocument/documentColor"
        | "textDocument/codeAction" => Needs::Fresh,
        _ => Needs::Text,
    }
}

/// How a request is answered.
pub(super) enum Answer {
    Now(Result<Value, Refusal>),
    /// With a place in one of the scene's texts.
    Definition(Option<(Arc<Looked>, Span)>),
    /// With words for the person.
    Told(String),
    /// When all scenes of the library were looked at.
    Later(Task),
}

/// A request with what is known of its text.
pub(super) struct Asked<'a> {
    request: &'a Request,
    buffer: Option<&'a Buffer>,
    looked: Option<Arc<Looked>>,
    client: Client,
    server: &'a Server,
}

type Answered = Result<Value, Refusal>;

impl<'a> Asked<'a> {
    pub(super) fn new(
        request: &'a Request,
        buffer: Option<&'a Buffer>,
        looked: Option<Arc<Looked>>,
        server: &'a Server,
    ) -> Self {
        Self { request, buffer, looked, client: server.client, server }
    }

    fn params<T: DeserializeOwned>(&self) -> Result<T, Refusal> {
        serde_json::from_value(self.request.params.clone())
            .map_err(|error| Refusal::new(ErrorCode::InvalidParams, error.to_string()))
    }

    pub(super) fn answer(&self) -> Answer {
        let answered = match self.request.method.as_str() {
            "textDocument/completion" => self.completion(),
            "textDocument/signatureHelp" => self.signature_help(),
            "textDocument/hover" => self.hover(),
            "textDocument/documentHighlight" => self.highlights(),
            "textDocument/formatting" => self.formatting(),
            "textDocument/documentSymbol" => self.symbols(),
            "textDocument/foldingRange" => self.foldings(),
            "textDocument/documentColor" => self.colours(),
            "textDocument/colorPresentation" => self.presentations(),
            "textDocument/codeAction" => self.actions(),
            "textDocument/prepareRename" => self.prepare_rename(),
            "textDocument/definition" => match self.definition() {
                Ok(place) => return Answer::Definition(place),
                Err(refusal) => Err(refusal),
            },
            "textDocument/references" => match self.references() {
                Ok(Some(task)) => return Answer::Later(task),
                Ok(None) => Ok(json!([])),
                Err(refusal) => Err(refusal),
            },
            "textDocument/rename" => match self.rename() {
                Ok(task) => return Answer::Later(task),
                Err(refusal) => Err(refusal),
            },
            "workspace/executeCommand" => match self.command() {
                Ok(words) => return Answer::Told(words),
                Err(refusal) => Err(refusal),
            },
            method => Err(Refusal::new(ErrorCode::MethodNotFound, format!("there is no `{method}` here"))),
        };
        Answer::Now(answered)
    }

    /// The open text with its look, and the place in the scene that a position means.
    fn spot(&self, position: Position) -> Option<(&Buffer, &Looked, Spot)> {
        let (buffer, looked) = (self.buffer?, self.looked.as_ref()?);
        Some((buffer, looked, Spot { source: looked.main()?, offset: buffer.text.offset(position) }))
    }

    fn seen<'l>(&self, looked: &'l Looked) -> Option<Seen<'l>> {
        Some(Seen { analysis: &looked.analysis, source: looked.main()? })
    }

    // ------------------------------------------------------------------------------------------- writing

    fn completion(&self) -> Answered {
        let params: CompletionParams = self.params()?;
        let Some((buffer, looked, spot)) = self.spot(params.text_document_position.position) else {
            return Ok(json!([]));
        };
        let (Some(seen), BufferKind::Kake) = (self.seen(looked), buffer.kind) else { return Ok(json!([])) };
        let folder = Beside::new(&buffer.path, &looked.root);
        let items = lsp::complete(&buffer.text, spot.offset, seen, self.client.snippets, &folder);
        Ok(json!({ "isIncomplete": false, "items": items }))
    }

    fn signature_help(&self) -> Answered {
        let params: SignatureHelpParams = self.params()?;
        let position = params.text_document_position_params.position;
        let Some((buffer, looked, spot)) = self.spot(position) else { return Ok(Value::Null) };
        let (Some(seen), BufferKind::Kake) = (self.seen(looked), buffer.kind) else { return Ok(Value::Null) };
        Ok(json!(lsp::help(&buffer.text, spot.offset, seen)))
    }

    fn formatting(&self) -> Answered {
        let _: DocumentFormattingParams = self.params()?;
        let Some(buffer) = self.buffer.filter(|buffer| buffer.kind == BufferKind::Kake) else { return Ok(Value::Null) };
        let text = buffer.text.as_str();
        let source = Sources::new().add("", "", Syntax::Kake);
        let (document, diagnostics) = kake::parse(source, text);
        // What could not be read has no form, and is left as it is.
        if diagnostics.iter().any(crate::diag::Diagnostic::is_error) {
            return Ok(Value::Null);
        }
        let mut formatted = format::format(&document, text);
        if text.contains("\r\n") {
            formatted = formatted.replace('\n', "\r\n");
        }
        Ok(json!(edits(&buffer.text, &formatted)))
    }

    // ------------------------------------------------------------------------------------------- reading

    fn hover(&self) -> Answered {
        let params: HoverParams = self.params()?;
        let position = params.text_document_position_params.position;
        let Some((buffer, looked, spot)) = self.spot(position) else { return Ok(Value::Null) };
        let Some((span, words)) = lsp::hover(&looked.analysis, spot, buffer.kind == BufferKind::Toml) else {
            return Ok(Value::Null);
        };
        let contents = HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value: words });
        let range = buffer.text.range(span.start as usize..span.end as usize);
        Ok(json!(Hover { contents, range: Some(range) }))
    }

    fn definition(&self) -> Result<Option<(Arc<Looked>, Span)>, Refusal> {
        let params: TextDocumentPositionParams = self.params()?;
        let Some((_, looked, spot)) = self.spot(params.position) else { return Ok(None) };
        let analysis = &looked.analysis;
        let file = analysis.import_at(spot).map(|(_, source)| Span::new(source, 0, 0));
        let place = file.or_else(|| analysis.name_at(spot).map(|(_, name)| name));
        Ok(place.zip(self.looked.clone()).map(|(span, looked)| (looked, span)))
    }

    fn highlights(&self) -> Answered {
        let params: TextDocumentPositionParams = self.params()?;
        let Some((buffer, looked, spot)) = self.spot(params.position) else { return Ok(json!([])) };
        let Some((_, name)) = looked.analysis.name_at(spot) else { return Ok(json!([])) };
        let here = looked.analysis.places_of(name).into_iter().filter(|span| span.source == spot.source);
        let list = here.map(|span| DocumentHighlight {
            range: buffer.text.range(span.start as usize..span.end as usize),
            kind: None,
        });
        Ok(json!(list.collect::<Vec<_>>()))
    }

    /// The document of an open text, read now.
    fn document(&self) -> Option<(&Buffer, Document)> {
        let buffer = self.buffer?;
        let text = buffer.text.as_str();
        let source: SourceId = Sources::new().add("", "", Syntax::Kake);
        match buffer.kind {
            BufferKind::Kake => Some((buffer, kake::parse(source, text).0)),
            BufferKind::Toml => Some((buffer, toml::read(source, text).0)),
            BufferKind::Manifest | BufferKind::Other => None,
        }
    }

    fn symbols(&self) -> Answered {
        let symbols = self.document().map(|(buffer, document)| lsp::symbols(&document, &buffer.text));
        Ok(json!(symbols.unwrap_or_default()))
    }

    fn foldings(&self) -> Answered {
        let buffer = self.buffer.filter(|buffer| buffer.kind == BufferKind::Kake);
        Ok(json!(buffer.map(|buffer| lsp::foldings(&buffer.text)).unwrap_or_default()))
    }

    fn colours(&self) -> Answered {
        let (Some(buffer), Some(looked)) = (self.buffer, &self.looked) else { return Ok(json!([])) };
        let colours = looked.main().map(|source| lsp::colours(&looked.analysis, source, &buffer.text));
        Ok(json!(colours.unwrap_or_default()))
    }

    fn presentations(&self) -> Answered {
        let params: ColorPresentationParams = self.params()?;
        Ok(json!(lsp::presentations(&params.color)))
    }

    // ------------------------------------------------------------------------------------------- mending

    fn actions(&self) -> Answered {
        let params: CodeActionParams = self.params()?;
        let (Some(buffer), Some(looked)) = (self.buffer, &self.looked) else { return Ok(json!([])) };
        let Some(main) = looked.main() else { return Ok(json!([])) };
        let wanted = buffer.text.bytes(params.range);
        let mut actions = Vec::new();
        let mut explained: Vec<Code> = Vec::new();
        for diagnostic in &looked.analysis.diagnostics {
            let Some(span) = diagnostic.span.filter(|span| span.source == main) else { continue };
            let near = |offset| touches(span, Spot { source: main, offset });
            let lies_in = wanted.contains(&(span.start as usize));
            if !near(wanted.start) && !near(wanted.end) && !lies_in {
                continue;
            }
            if let Some(fix) = lsp::fixes(diagnostic, &looked.analysis.sources) {
                let range = buffer.text.range(fix.span.start as usize..fix.span.end as usize);
                let edit = TextEdit { range, new_text: fix.text };
                actions.push(json!({
                    "title": fix.title,
                    "kind": "quickfix",
                    "isPreferred": true,
                    "diagnostics": self.told(&params, diagnostic.code, buffer.text.range(span.start as usize..span.end as usize)),
                    "edit": { "changes": { buffer.uri.as_str(): [edit] } },
                }));
            }
            if !explained.contains(&diagnostic.code) {
                explained.push(diagnostic.code);
            }
        }
        for code in explained {
            let title = format!("Explain {code}");
            let command = json!({ "title": title, "command": EXPLAIN, "arguments": [code.to_string()] });
            actions.push(json!({ "title": title, "kind": "quickfix", "command": command }));
        }
        Ok(json!(actions))
    }

    /// The diagnostics of the request that a fix mends.
    fn told(&self, params: &CodeActionParams, code: Code, range: lsp_types::Range) -> Vec<lsp_types::Diagnostic> {
        let code = lsp_types::NumberOrString::String(code.to_string());
        let same =
            params.context.diagnostics.iter().filter(|told| told.range == range && told.code.as_ref() == Some(&code));
        same.cloned().collect()
    }

    fn command(&self) -> Result<String, Refusal> {
        let command = self.request.params.get("command").and_then(Value::as_str).unwrap_or_default();
        if command != EXPLAIN {
            let words = format!("there is no command `{command}` here");
            return Err(Refusal::new(ErrorCode::InvalidParams, words));
        }
        let name = self.request.params.pointer("/arguments/0").and_then(Value::as_str).unwrap_or_default();
        match Code::from_name(name) {
            Some(code) => Ok(format!("{code}: {}\n\n{}", code.title(), code.explanation())),
            None => Err(Refusal::new(ErrorCode::InvalidParams, format!("there is no code `{name}`"))),
        }
    }

    // ------------------------------------------------------------------------------------------- names

    fn prepare_rename(&self) -> Answered {
        let params: TextDocumentPositionParams = self.params()?;
        let Some((buffer, looked, spot)) = self.spot(params.position) else { return Ok(Value::Null) };
        match lsp::renameable(&looked.analysis, spot) {
            Ok((span, _)) => {
                let bytes = span.start as usize..span.end as usize;
                let written = buffer.text.as_str().get(bytes.clone()).unwrap_or_default();
                Ok(json!({ "range": buffer.text.range(bytes), "placeholder": written }))
            }
            Err(words) => Err(Refusal::new(ErrorCode::RequestFailed, words)),
        }
    }

    fn task(
        &self,
        work: impl FnOnce(&renaming::Asked) -> Outcome + Send + 'static,
        position: Position,
    ) -> Option<Task> {
        let (buffer, _, spot) = self.spot(position)?;
        let stop = Stop::new();
        let asked = renaming::Asked {
            scene: buffer.path.clone(),
            offset: spot.offset,
            texts: self.server.texts(),
            encoding: self.client.encoding,
            addresses: self.server.addresses(),
            stop: stop.clone(),
        };
        let id: RequestId = self.request.id.clone();
        let uri = buffer.uri.as_str().to_owned();
        let cancelled = Refusal::new(ErrorCode::RequestCanceled, "cancelled");
        let watched = stop.clone();
        let work = move || {
            let outcome = work(&asked);
            if watched.is_asked() { Outcome::Answer(Err(cancelled), None) } else { outcome }
        };
        Some(Task { id, uri, stop, work: Box::new(work) })
    }

    fn references(&self) -> Result<Option<Task>, Refusal> {
        let params: ReferenceParams = self.params()?;
        let position = params.text_document_position.position;
        let with_declaration = params.context.include_declaration;
        let declared = self.spot(position).and_then(|(_, looked, spot)| {
            let (_, name) = looked.analysis.name_at(spot)?;
            let source = looked.analysis.sources.get(name.source);
            let text = Text::new(Arc::clone(&source.text), self.client.encoding);
            Some((looked.place(name.source)?.to_owned(), text.range(name.start as usize..name.end as usize)))
        });
        let work = move |asked: &renaming::Asked| {
            // A name of a standard library is not looked for elsewhere.
            let places = asked.places().unwrap_or_default();
            let is_declaration = |place: &lsp_types::Location| {
                declared.as_ref().is_some_and(|(path, range)| {
                    place.range == *range && super::address::path(&place.uri).as_ref() == Some(path)
                })
            };
            let list: Vec<_> = places.into_iter().filter(|place| with_declaration || !is_declaration(place)).collect();
            Outcome::Answer(Ok(json!(list)), None)
        };
        Ok(self.task(work, position))
    }

    fn rename(&self) -> Result<Task, Refusal> {
        let params: RenameParams = self.params()?;
        let (new, position) = (params.new_name, params.text_document_position.position);
        let work = move |asked: &renaming::Asked| match asked.rename(&new) {
            Ok(renaming::Renamed { files, remark }) => {
                let changes: serde_json::Map<String, Value> =
                    files.into_iter().map(|(uri, edits)| (uri.as_str().to_owned(), json!(edits))).collect();
                Outcome::Answer(Ok(json!({ "changes": changes })), remark)
            }
            Err(words) => Outcome::Answer(Err(Refusal::new(ErrorCode::RequestFailed, words)), None),
        };
        self.task(work, position)
            .ok_or_else(|| Refusal::new(ErrorCode::RequestFailed, "there is no scene open at this address"))
    }
}

/// What makes one text of another: one edit of the lines that differ, so that the cursor elsewhere stays where it is.
fn edits(old: &Text, new: &str) -> Vec<TextEdit> {
    let text = old.as_str();
    if text == new {
        return Vec::new();
    }
    let shared = |a: &str, b: &str| a.bytes().zip(b.bytes()).take_while(|(a, b)| a == b).count();
    let before = shared(text, new);
    // Back to a line's beginning, which both have.
    let before = text.get(..before).map_or(0, |same| same.rfind('\n').map_or(0, |at| at + 1));
    let (rest_old, rest_new) = (text.get(before..).unwrap_or_default(), new.get(before..).unwrap_or_default());
    let after = rest_old.bytes().rev().zip(rest_new.bytes().rev()).take_while(|(a, b)| a == b).count();
    let tail = rest_old.get(rest_old.len() - after..);
    // On to the next line's beginning.
    let after = tail.and_then(|tail| tail.find('\n').map(|at| after - at - 1)).unwrap_or(0);
    let range = old.range(before..text.len() - after);
    let new_text = rest_new.get(..rest_new.len() - after).unwrap_or_default().to_owned();
    vec![TextEdit { range, new_text }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_make_the_new_text_and_spare_the_rest() {
        let cases =
            [("a\nb\nc\n", "a\nx\nc\n"), ("か\nb", "き\nb\n"), ("", "a\n"), ("a\r\nb\r\n", "a\r\n"), ("a\na\n", "a\n")];
        for (old, new) in cases {
            let text = Text::new(old.into(), Encoding::Utf16);
            let made =
                edits(&text, new).into_iter().fold(text, |text, edit| text.edited(Some(edit.range), &edit.new_text));
            assert_eq!(made.as_str(), new);
        }
        let text = Text::new("a\nb\nc\n".into(), Encoding::Utf16);
        assert_eq!(edits(&text, "a\nx\nc\n").first().map(|edit| edit.new_text.as_str()), Some("x\n"));
    }
}
