//! The parts of a text: what it declares and draws, and what can be folded away.

use lsp_types::{DocumentSymbol, FoldingRange, FoldingRangeKind, SymbolKind};

use crate::span::Span;
use crate::syntax::ast::{Document, Expr, Ident, Parameter, Property, Statement, StatementKind, ToneBody};
use crate::syntax::kake::{self, TokenKind};

use super::declared::{one_line, parameter};
use super::text::Text;

/// What a document declares and draws, in order and with what is inside each.
#[must_use]
pub fn symbols(document: &Document, text: &Text) -> Vec<DocumentSymbol> {
    let outline = Outline { text };
    // Blocks are no deeper than a text may be nested.
    document.statements.iter().filter_map(|statement| outline.statement(statement)).collect()
}

struct Outline<'t> {
    text: &'t Text,
}

impl Outline<'_> {
    fn symbol(
        &self,
        name: String,
        kind: SymbolKind,
        (whole, chosen): (Span, Span),
        detail: String,
        children: Vec<DocumentSymbol>,
    ) -> DocumentSymbol {
        let range = |span: Span| self.text.range(span.start as usize..span.end as usize);
        let whole = whole.to(chosen);
        #[allow(deprecated)]
        DocumentSymbol {
            // A symbol without a name is refused by editors.
            name: if name.trim().is_empty() { "…".to_owned() } else { name },
            detail: (!detail.is_empty()).then_some(detail),
            kind,
            tags: None,
            deprecated: None,
            range: range(whole),
            selection_range: range(chosen),
            children: (!children.is_empty()).then_some(children),
        }
    }

    fn statement(&self, statement: &Statement) -> Option<DocumentSymbol> {
        let span = statement.span;
        let named = |name: &Ident, kind, detail: String, children| {
            Some(self.symbol(name.name.clone(), kind, (span, name.span), detail, children))
        };
        let block = |body: &[Statement]| body.iter().filter_map(|inner| self.statement(inner)).collect::<Vec<_>>();
        let whole = |name: String, kind, detail: String, children| {
            Some(self.symbol(name, kind, (span, span.at_start()), detail, children))
        };
        match &statement.kind {
            StatementKind::Import { path, alias } => {
                let name = alias.as_ref().map_or(path.value.clone(), |alias| alias.name.clone());
                let chosen = alias.as_ref().map_or(path.span, |alias| alias.span);
                Some(self.symbol(name, SymbolKind::MODULE, (span, chosen), path.value.clone(), Vec::new()))
            }
            StatementKind::Canvas(properties) => {
                whole("canvas".to_owned(), SymbolKind::OBJECT, String::new(), self.properties(properties))
            }
            StatementKind::Let(binding) => {
                named(&binding.name, SymbolKind::VARIABLE, one_line(&binding.value), Vec::new())
            }
            StatementKind::Param { binding, .. } => {
                named(&binding.name, SymbolKind::CONSTANT, one_line(&binding.value), Vec::new())
            }
            StatementKind::Field(binding) => {
                named(&binding.name, SymbolKind::FIELD, one_line(&binding.value), Vec::new())
            }
            StatementKind::Region(binding) => {
                named(&binding.name, SymbolKind::INTERFACE, one_line(&binding.value), Vec::new())
            }
            StatementKind::Tone { name, params, body } => {
                let properties = match body {
                    ToneBody::Properties(properties) | ToneBody::Derived { with: properties, .. } => properties,
                };
                let mut children = self.parameters(params);
                children.extend(self.properties(properties));
                let detail = match body {
                    ToneBody::Derived { base, .. } => format!("= {}", one_line(base)),
                    ToneBody::Properties(_) => String::new(),
                };
                named(name, SymbolKind::CLASS, detail, children)
            }
            StatementKind::Fn { name, params, body } => {
                named(name, SymbolKind::FUNCTION, one_line(body), self.parameters(params))
            }
            StatementKind::Paint { region, tone, name, .. } => {
                let what = name.as_ref().map_or_else(|| one_line(tone), plain);
                whole(format!("paint {what}"), SymbolKind::EVENT, one_line(region), Vec::new())
            }
            StatementKind::Outline { region, .. } => {
                whole("outline".to_owned(), SymbolKind::EVENT, one_line(region), Vec::new())
            }
            StatementKind::Ink { drawing } => whole("ink".to_owned(), SymbolKind::EVENT, one_line(drawing), Vec::new()),
            StatementKind::Layer { name, body, .. } => {
                whole(format!("layer {}", plain(name)), SymbolKind::NAMESPACE, String::new(), block(body))
            }
            StatementKind::For { variable, iterable, body } => {
                let name = format!("for {} in {}", variable.name, one_line(iterable));
                whole(name, SymbolKind::NAMESPACE, String::new(), block(body))
            }
            StatementKind::If { branches, otherwise } => {
                let condition = branches.first().map(|(condition, _)| one_line(condition)).unwrap_or_default();
                let bodies = branches.iter().map(|(_, body)| body).chain(otherwise.iter());
                let children = bodies.flat_map(|body| block(body)).collect();
                whole(format!("if {condition}"), SymbolKind::NAMESPACE, String::new(), children)
            }
            StatementKind::Experiment { name, properties } => {
                named(name, SymbolKind::OBJECT, "experiment".to_owned(), self.properties(properties))
            }
            StatementKind::Edition(_) | StatementKind::Seed(_) => None,
        }
    }

    fn properties(&self, properties: &[Property]) -> Vec<DocumentSymbol> {
        let symbols = properties.iter().map(|property| {
            let spans = (property.span(), property.name.span);
            let detail = one_line(&property.value);
            self.symbol(property.name.name.clone(), SymbolKind::PROPERTY, spans, detail, Vec::new())
        });
        symbols.collect()
    }

    fn parameters(&self, params: &[Parameter]) -> Vec<DocumentSymbol> {
        let symbols = params.iter().map(|param| {
            let end = param.default.as_ref().map_or(param.name.span, |default| default.span);
            let spans = (param.name.span.to(end), param.name.span);
            self.symbol(param.name.name.clone(), SymbolKind::TYPE_PARAMETER, spans, parameter(param), Vec::new())
        });
        symbols.collect()
    }
}

/// A name as it is read: a string without its quotes.
fn plain(expr: &Expr) -> String {
    one_line(expr).trim_matches('"').to_owned()
}

/// What can be folded away in a `.kake` text: brackets over several lines, comments and runs of imports.
#[must_use]
pub fn foldings(text: &Text) -> Vec<FoldingRange> {
    let (tokens, comments) = kake::tokens(text.as_str());
    let mut folds = Vec::new();
    let mut fold = |start: usize, end: usize, kind: Option<FoldingRangeKind>| {
        if start < end {
            let line = |line: usize| u32::try_from(line).unwrap_or(u32::MAX);
            folds.push(FoldingRange { start_line: line(start), end_line: line(end), kind, ..FoldingRange::default() });
        }
    };
    let mut open: Vec<usize> = Vec::new();
    for token in &tokens {
        match token.kind {
            TokenKind::Open => open.push(token.start),
            TokenKind::Close => {
                if let Some(start) = open.pop() {
                    // The line of the closing bracket stays.
                    fold(text.line_of(start), text.line_of(token.start).saturating_sub(1), None);
                }
            }
            _ => {}
        }
    }
    // Comments on lines below each other are one.
    let mut run: Option<(usize, usize)> = None;
    for comment in comments {
        let (first, last) = (text.line_of(comment.start), text.line_of(comment.end.max(1) - 1));
        run = match run {
            Some((start, end)) if first <= end + 1 => Some((start, last)),
            Some((start, end)) => {
                fold(start, end, Some(FoldingRangeKind::Comment));
                Some((first, last))
            }
            None => Some((first, last)),
        };
    }
    if let Some((start, end)) = run {
        fold(start, end, Some(FoldingRangeKind::Comment));
    }
    let import = |token: &kake::Token| token.leads && text.as_str().get(token.start..token.end) == Some("import");
    let imports: Vec<usize> = tokens.iter().filter(|token| import(token)).map(|t| text.line_of(t.start)).collect();
    if let (Some(first), Some(last)) = (imports.first(), imports.last())
        && last - first < imports.len() * 2
    {
        fold(*first, *last, Some(FoldingRangeKind::Imports));
    }
    folds
}
