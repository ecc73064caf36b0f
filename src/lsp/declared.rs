//! What a document declares: every name with what it is declared as, its doc comment and how it reads.

use crate::lower::reference::Kind;
use crate::span::Span;
use crate::syntax::ast::{
    Binding, Document, Expr, ExprKind, Ident, Parameter, Statement, StatementKind, Text, ToneBody, Unit,
};
use crate::syntax::format;

/// A declared name.
#[derive(Debug, Clone, Copy)]
pub struct Declared<'a> {
    /// The name.
    pub name: &'a Ident,
    /// The doc comment.
    pub doc: Option<&'a str>,
    /// What it is.
    pub what: What<'a>,
    /// The whole declaration.
    pub span: Span,
    /// Whether the file's top level declares it, so that other files may see it.
    pub is_top: bool,
}

/// What a name is declared as.
#[derive(Debug, Clone, Copy)]
pub enum What<'a> {
    /// `let`
    Let(&'a Binding),
    /// `field`
    Field(&'a Binding),
    /// `region`
    Region(&'a Binding),
    /// `param`, with its range or choices.
    Param(&'a Binding, Option<&'a Expr>),
    /// `tone`
    Tone(&'a [Parameter], &'a ToneBody),
    /// `fn`
    Fn(&'a [Parameter], &'a Expr),
    /// A parameter of a tone or function, of this name.
    Parameter(&'a Ident, &'a Parameter),
    /// The variable of a loop, with what it goes over.
    Variable(&'a Expr),
    /// The name of an import.
    Module(&'a Text),
    /// `experiment`
    Experiment,
}

/// Every name that a document declares, in the order of the text.
#[must_use]
pub fn declared(document: &Document) -> Vec<Declared<'_>> {
    let mut found = Vec::new();
    let mut open: Vec<(&Statement, bool)> = document.statements.iter().rev().map(|s| (s, true)).collect();
    while let Some((statement, is_top)) = open.pop() {
        let doc = statement.doc.as_ref().map(|doc| doc.text.as_str());
        let mut add = |name, what| found.push(Declared { name, doc, what, span: statement.span, is_top });
        match &statement.kind {
            StatementKind::Let(binding) => add(&binding.name, What::Let(binding)),
            StatementKind::Field(binding) => add(&binding.name, What::Field(binding)),
            StatementKind::Region(binding) => add(&binding.name, What::Region(binding)),
            StatementKind::Param { binding, domain } => add(&binding.name, What::Param(binding, domain.as_ref())),
            StatementKind::Tone { name, params, body } => {
                add(name, What::Tone(params, body));
                found.extend(parameters(name, params));
            }
            StatementKind::Fn { name, params, body } => {
                add(name, What::Fn(params, body));
                found.extend(parameters(name, params));
            }
            StatementKind::Import { path, alias: Some(alias) } => add(alias, What::Module(path)),
            StatementKind::Experiment { name, .. } => add(name, What::Experiment),
            StatementKind::For { variable, iterable, body } => {
                add(variable, What::Variable(iterable));
                open.extend(body.iter().rev().map(|statement| (statement, false)));
            }
            StatementKind::Layer { body, .. } => open.extend(body.iter().rev().map(|statement| (statement, false))),
            StatementKind::If { branches, otherwise } => {
                let bodies = branches.iter().map(|(_, body)| body).chain(otherwise.iter());
                let inner: Vec<_> = bodies.flatten().map(|statement| (statement, false)).collect();
                open.extend(inner.into_iter().rev());
            }
            StatementKind::Import { alias: None, .. }
            | StatementKind::Edition(_)
            | StatementKind::Canvas(_)
            | StatementKind::Seed(_)
            | StatementKind::Paint { .. }
            | StatementKind::Outline { .. }
            | StatementKind::Ink { .. } => {}
        }
    }
    found
}

fn parameters<'a>(of: &'a Ident, params: &'a [Parameter]) -> impl Iterator<Item = Declared<'a>> {
    params.iter().map(move |param| Declared {
        name: &param.name,
        doc: param.doc.as_ref().map(|doc| doc.text.as_str()),
        what: What::Parameter(of, param),
        span: param.name.span,
        is_top: false,
    })
}

impl Declared<'_> {
    /// What it is, in a word.
    #[must_use]
    pub fn noun(&self) -> &'static str {
        match self.what {
            What::Let(_) => "let",
            What::Field(_) => "field",
            What::Region(_) => "region",
            What::Param(..) => "param",
            What::Tone(..) => "tone",
            What::Fn(..) => "function",
            What::Parameter(..) => "parameter",
            What::Variable(_) => "loop variable",
            What::Module(_) => "module",
            What::Experiment => "experiment",
        }
    }

    /// How it is declared, on one line without its body.
    #[must_use]
    pub fn heading(&self) -> String {
        let name = &self.name.name;
        match self.what {
            What::Let(binding) => format!("let {}", bound(binding)),
            What::Field(binding) => format!("field {}", bound(binding)),
            What::Region(binding) => format!("region {}", bound(binding)),
            What::Param(binding, domain) => {
                let domain = domain.map(|domain| format!(" in {}", one_line(domain))).unwrap_or_default();
                format!("param {}{domain}", bound(binding))
            }
            What::Tone(params, body) => {
                let list = if params.is_empty() { String::new() } else { format!("({})", listed(params)) };
                let base = match body {
                    ToneBody::Derived { base, .. } => format!(" = {}", one_line(base)),
                    ToneBody::Properties(_) => String::new(),
                };
                format!("tone {name}{list}{base}")
            }
            What::Fn(params, body) => format!("fn {name}({}) = {}", listed(params), one_line(body)),
            What::Parameter(_, param) => parameter(param),
            What::Variable(iterable) => format!("for {name} in {}", one_line(iterable)),
            What::Module(path) => format!("import \"{}\" as {name}", path.value),
            What::Experiment => format!("experiment {name}"),
        }
    }

    /// What it takes where it is called.
    #[must_use]
    pub fn parameters(&self) -> Option<&[Parameter]> {
        match self.what {
            What::Tone(params, _) | What::Fn(params, _) => Some(params),
            _ => None,
        }
    }
}

fn bound(binding: &Binding) -> String {
    let ty = binding.ty.as_ref().map(|ty| format!(": {}", ty.name)).unwrap_or_default();
    format!("{}{ty} = {}", binding.name.name, one_line(&binding.value))
}

fn listed(params: &[Parameter]) -> String {
    params.iter().map(parameter).collect::<Vec<_>>().join(", ")
}

/// A parameter as it is declared.
#[must_use]
pub(super) fn parameter(param: &Parameter) -> String {
    let ty = param.ty.as_ref().map(|ty| format!(": {}", ty.name)).unwrap_or_default();
    let default = param.default.as_ref().map(|default| format!(" = {}", one_line(default))).unwrap_or_default();
    format!("{}{ty}{default}", param.name.name)
}

/// The most characters of an expression that are shown.
const MOST: usize = 120;

/// An expression on one line, cut where it is long.
#[must_use]
pub(super) fn one_line(expr: &Expr) -> String {
    let text = format::expression(expr).split_whitespace().collect::<Vec<_>>().join(" ");
    match text.char_indices().nth(MOST) {
        Some((cut, _)) => format!("{}…", text.get(..cut).unwrap_or_default()),
        None => text,
    }
}

/// The kind of a parameter, as far as its declaration shows it.
#[must_use]
pub(super) fn kind_of(param: &Parameter) -> Option<Kind> {
    if let Some(ty) = &param.ty {
        return Kind::from_name(&ty.name);
    }
    match &param.default.as_ref()?.kind {
        ExprKind::Number { unit: None, .. } => Some(Kind::Number),
        ExprKind::Number { unit: Some(unit), .. } => Some(match unit {
            Unit::Millimetre | Unit::Centimetre | Unit::Inch | Unit::Point | Unit::Pixel => Kind::Length,
            Unit::Degree | Unit::Radian | Unit::Turn => Kind::Angle,
            Unit::Percent => Kind::Percentage,
        }),
        ExprKind::String(_) => Some(Kind::String),
        ExprKind::Colour(_) => Some(Kind::Colour),
        ExprKind::Bool(_) => Some(Kind::Bool),
        _ => None,
    }
}
