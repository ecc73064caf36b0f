//! Reading a scene with all it imports, and the tables of what each file declares.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::loader::{self, LoadError, Loader, Unfound};
use crate::span::{Sources, Span, Syntax};
use crate::syntax::ast::{Document, ExprKind, StatementKind, Text, ToneBody};
use crate::syntax::{self, ast, kake};

use super::cx::Cx;
use super::scope::{Binding, Declared, Scope};
use super::survey::Survey;
use super::{draw, function, library, names, tone};

/// How many files deep imports may go.
const IMPORT_DEPTH: usize = 64;

/// A file with what it imports.
#[derive(Debug)]
pub(super) struct File {
    path: String,
    document: Document,
    /// Where some of it could not be read: the names that its text declares.
    broken: Option<Vec<String>>,
    /// For every import statement that could be followed: the file's index and the statement's.
    imports: Vec<(usize, usize)>,
}

/// What a file declares.
#[derive(Debug)]
pub(super) struct Module<'a> {
    pub(super) path: &'a str,
    pub(super) document: &'a Document,
    /// `let`, `param`, `field` and `region`.
    pub(super) scope: Rc<Scope<'a>>,
    pub(super) tones: BTreeMap<&'a str, Tone<'a>>,
    pub(super) functions: BTreeMap<&'a str, Function<'a>>,
    /// Imports with `as`.
    pub(super) aliases: BTreeMap<&'a str, usize>,
    /// Imports without.
    pub(super) opened: Vec<usize>,
    /// The names of imports that could not be read, which was reported.
    pub(super) lost: Vec<&'a str>,
    /// Whether an import without a name could not be read: nobody knows what it would have brought.
    pub(super) is_incomplete: bool,
    /// Some of its statements or properties could not be read, which was reported.
    pub(super) is_damaged: bool,
    /// Names whose declarations could not be read.
    pub(super) broken: BTreeSet<&'a str>,
    /// The names of the tones that others are derived from.
    pub(super) bases: BTreeSet<&'a str>,
}

/// A declared tone.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tone<'a> {
    pub(super) module: usize,
    pub(super) name: &'a ast::Ident,
    pub(super) params: &'a [ast::Parameter],
    pub(super) body: &'a ToneBody,
}

/// A declared function.
#[derive(Debug, Clone, Copy)]
pub(super) struct Function<'a> {
    pub(super) module: usize,
    pub(super) name: &'a ast::Ident,
    pub(super) params: &'a [ast::Parameter],
    pub(super) body: &'a ast::Expr,
}

/// Reads the scene and everything it imports, the scene first.
pub(super) fn read(
    path: &str,
    loader: &dyn Loader,
    sources: &mut Sources,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<File> {
    let mut reader =
        Reader { loader, sources, diagnostics, files: Vec::new(), known: BTreeMap::new(), open: Vec::new() };
    reader.read(path, None);
    reader.files
}

struct Reader<'r> {
    loader: &'r dyn Loader,
    sources: &'r mut Sources,
    diagnostics: &'r mut Vec<Diagnostic>,
    files: Vec<File>,
    known: BTreeMap<String, Option<usize>>,
    /// The files that are being read, outermost first, with the import that led to each.
    open: Vec<(String, Option<Span>)>,
}

impl Reader<'_> {
    /// Reads one file and what it imports; its index.
    fn read(&mut self, path: &str, from: Option<Span>) -> Option<usize> {
        if let Some(start) = self.open.iter().position(|(open, _)| open == path) {
            self.report_cycle(path, start, from);
            return None;
        }
        if let Some(&known) = self.known.get(path) {
            return known;
        }
        if self.open.len() >= IMPORT_DEPTH {
            let message = format!("imports lead more than {IMPORT_DEPTH} files deep");
            self.report(Code::Nesting, from, message, None);
            return None;
        }
        let index = self.files.len();
        let document = self.parse(path, from);
        self.known.insert(path.to_owned(), document.as_ref().map(|_| index));
        let (document, broken) = document?;
        let imports: Vec<(usize, Text)> = document
            .statements
            .iter()
            .enumerate()
            .filter_map(|(i, statement)| match &statement.kind {
                StatementKind::Import { path, .. } => Some((i, path.clone())),
                _ => None,
            })
            .collect();
        self.files.push(File { path: path.to_owned(), document, broken, imports: Vec::new() });
        self.open.push((path.to_owned(), from));
        for (statement, text) in imports {
            let Some(target) = self.target(path, &text) else { continue };
            if let Some(imported) = self.read(&target, Some(text.span)) {
                self.files[index].imports.push((statement, imported));
            }
        }
        self.open.pop();
        Some(index)
    }

    /// What the text of an import in the file at `path` names: a path from the root, or a standard library.
    fn target(&mut self, path: &str, text: &Text) -> Option<String> {
        if library::is_library(&text.value) {
            return Some(text.value.clone());
        }
        match loader::find(self.loader, path, &text.value) {
            Ok(target) => Some(target),
            Err(unfound) => {
                let (code, message, hint) = not_found(path, &text.value, &unfound);
                self.report(code, Some(text.span), message, Some(hint));
                None
            }
        }
    }

    /// The text of a standard library.
    fn library(&mut self, path: &str, from: Option<Span>) -> Option<Arc<[u8]>> {
        // A picture keeps the text that it was made with: later versions of the program may bring another.
        let found = self.loader.library(path).or_else(|| library::text(path).map(|text| text.as_bytes().into()));
        if let (None, Some(span)) = (&found, from) {
            self.diagnostics.push(library::unknown(path, span));
        }
        found
    }

    /// Reads one file's document, and the names that it means to declare where some of it could not be read.
    fn parse(&mut self, path: &str, from: Option<Span>) -> Option<(Document, Option<Vec<String>>)> {
        let extension = path.rsplit_once('.').map_or("", |(_, extension)| extension);
        let is_library = from.is_some() && library::is_library(path);
        let is_toml = extension.eq_ignore_ascii_case("toml") && !is_library;
        let bytes = match is_library {
            true => self.library(path, from)?,
            false => match self.loader.load(path) {
                Ok(bytes) => bytes,
                Err(error) => {
                    let (code, message, hint) = load_error(path, &error);
                    let code = if from.is_some() && code == Code::File { Code::Import } else { code };
                    self.report(code, from, message, hint);
                    return None;
                }
            },
        };
        if from.is_some() && !is_library && !is_toml && !extension.eq_ignore_ascii_case("kake") {
            let hint = "imports are scenes and libraries: `.kake` or `.toml` files".to_owned();
            self.report(Code::Import, from, format!("`{path}` is no scene"), Some(hint));
            return None;
        }
        let syntax = if is_toml { Syntax::Toml } else { Syntax::Kake };
        let (source, text) = match syntax::decode(path, &bytes, syntax, self.sources) {
            Ok(decoded) => decoded,
            Err(mut diagnostic) => {
                diagnostic.notes.extend(from.map(|span| (span, "imported here".to_owned())));
                self.diagnostics.push(diagnostic);
                return None;
            }
        };
        let (document, diagnostics) = match syntax {
            Syntax::Kake => kake::parse(source, &text),
            Syntax::Toml => syntax::toml::read(source, &text),
        };
        let damaged = diagnostics.iter().any(Diagnostic::is_error);
        self.diagnostics.extend(diagnostics);
        Some((document, damaged.then(|| declared_words(&text))))
    }

    fn report_cycle(&mut self, path: &str, start: usize, from: Option<Span>) {
        let mut message = format!("`{path}` imports itself");
        if self.open.len() > start + 1 {
            let way: Vec<_> = self.open[start + 1..].iter().map(|(path, _)| format!("`{path}`")).collect();
            message = format!("{message} by way of {}", way.join(" and "));
        }
        let mut diagnostic = match from {
            Some(span) => Diagnostic::error(Code::Cycle, span, message).label("and round again"),
            None => Diagnostic::without_span(Code::Cycle, message),
        };
        for (path, span) in &self.open[start + 1..] {
            if let Some(span) = span {
                diagnostic = diagnostic.note(*span, format!("`{path}` is imported here"));
            }
        }
        self.diagnostics.push(diagnostic);
    }

    fn report(&mut self, code: Code, span: Option<Span>, message: String, hint: Option<String>) {
        let diagnostic = match span {
            Some(span) => Diagnostic::error(code, span, message),
            None => Diagnostic::without_span(code, message),
        };
        self.diagnostics.push(diagnostic.maybe_hint(hint));
    }
}

/// What to say of a file that cannot be loaded.
pub(super) fn load_error(path: &str, error: &LoadError) -> (Code, String, Option<String>) {
    match error {
        LoadError::Missing => (Code::File, format!("there is no file `{path}`"), Some(PATH_HINT.to_owned())),
        LoadError::Outside => {
            let hint = if loader::split(path).0.is_empty() { ROOT_HINT } else { LIBRARY_HINT };
            (Code::Outside, outside(path), Some(hint.to_owned()))
        }
        LoadError::Unreadable(why) => (Code::File, format!("`{path}` cannot be read: {why}"), None),
    }
}

/// What to say of a path in the file `from` that names no file.
pub(super) fn not_found(from: &str, path: &str, unfound: &Unfound) -> (Code, String, String) {
    let (of, _) = loader::split(from);
    let (name, known) = match unfound {
        Unfound::Outside if of.is_empty() && !path.contains(':') => {
            return (Code::Outside, outside(path), ROOT_HINT.to_owned());
        }
        Unfound::Outside => return (Code::Outside, outside(path), LIBRARY_HINT.to_owned()),
        Unfound::NoDependency { name, known } => (name, known),
    };
    let message = format!("there is no dependency `{name}`");
    let manifest = loader::join(of, "kake.toml");
    let hint = did_you_mean(name, known.iter().map(String::as_str)).unwrap_or_else(|| match known.as_slice() {
        [] => format!("`{manifest}` declares it: `[dependencies]` and `{name} = {{ path = \"../{name}\" }}`"),
        known => {
            let known: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
            format!("`{manifest}` declares {}", known.join(", "))
        }
    });
    (Code::Dependency, message, hint)
}

/// What to say of a path that leads out of its library.
fn outside(path: &str) -> String {
    match loader::split(path) {
        ("", _) => format!("`{path}` leads out of the scene's root folder"),
        (key, _) => format!("`{path}` leads out of the folder of the dependency `{key}`"),
    }
}

const PATH_HINT: &str = "paths start at the folder of the file that names them";
/// How to reach files outside the root.
const ROOT_HINT: &str = "a scene reads only files below its root; `--root DIR` or a `kake.toml` further up widens it";
/// What libraries may read.
const LIBRARY_HINT: &str = "a library reads files in its own folder, and in those of the dependencies it declares";

/// Makes the tables of every file, and reports names that are declared twice.
pub(super) fn declare<'a>(files: &'a [File], diagnostics: &mut Vec<Diagnostic>) -> Vec<Module<'a>> {
    let mut modules: Vec<Module<'a>> =
        files.iter().enumerate().map(|(index, file)| declare_one(index, file, diagnostics)).collect();
    for (index, file) in files.iter().enumerate() {
        for &(statement, imported) in &file.imports {
            let statement = &file.document.statements[statement];
            let StatementKind::Import { alias, .. } = &statement.kind else { continue };
            match alias {
                Some(alias) => {
                    let earlier = modules[index].aliases.insert(&alias.name, imported);
                    if earlier.is_some() {
                        let message = format!("the module name `{}` is given twice", alias.name);
                        diagnostics.push(Diagnostic::error(Code::Duplicate, alias.span, message));
                    }
                }
                None if modules[index].opened.contains(&imported) => {}
                None => {
                    clashes(&modules, index, imported, statement.span, diagnostics);
                    modules[index].opened.push(imported);
                }
            }
        }
    }
    modules
}

fn declare_one<'a>(index: usize, file: &'a File, diagnostics: &mut Vec<Diagnostic>) -> Module<'a> {
    let mut module = Module {
        path: &file.path,
        document: &file.document,
        scope: Scope::module(index),
        tones: BTreeMap::new(),
        functions: BTreeMap::new(),
        aliases: BTreeMap::new(),
        opened: Vec::new(),
        lost: Vec::new(),
        is_incomplete: false,
        is_damaged: file.broken.is_some(),
        broken: BTreeSet::new(),
        bases: BTreeSet::new(),
    };
    module.broken.extend(file.broken.iter().flatten().map(String::as_str));
    for (i, statement) in file.document.statements.iter().enumerate() {
        let twice = match &statement.kind {
            StatementKind::Import { alias, .. } if !file.imports.iter().any(|(import, _)| *import == i) => {
                match alias {
                    Some(alias) => module.lost.push(&alias.name),
                    None => module.is_incomplete = true,
                }
                None
            }
            StatementKind::Tone { name, params, body } => {
                let tone = Tone { module: index, name, params, body };
                module.bases.extend(base_of(body));
                module.tones.insert(&name.name, tone).map(|earlier| (name, earlier.name.span))
            }
            StatementKind::Fn { name, params, body } => {
                let function = Function { module: index, name, params, body };
                module.functions.insert(&name.name, function).map(|earlier| (name, earlier.name.span))
            }
            kind => declare_binding(kind, &module.scope),
        };
        if let Some((name, earlier)) = twice {
            diagnostics.push(declared_twice(name, earlier));
        }
    }
    module
}

/// The name of the tone that another is derived from.
fn base_of(body: &ToneBody) -> Option<&str> {
    let ToneBody::Derived { base, .. } = body else { return None };
    let named = match &base.kind {
        ExprKind::Call(callee, _) => callee,
        _ => base,
    };
    match &named.kind {
        ExprKind::Name(name) => Some(name),
        ExprKind::Member(_, name) => Some(&name.name),
        _ => None,
    }
}

/// Names that a text means to declare, for a file in which some statements could not be read.
fn declared_words(text: &str) -> Vec<String> {
    const WORDS: [&str; 6] = ["let", "param", "field", "region", "tone", "fn"];
    let mut words = text.split(|character: char| !character.is_alphanumeric() && character != '_');
    let mut names = Vec::new();
    while let Some(word) = words.next() {
        if WORDS.contains(&word)
            && let Some(name) = words.next()
            && kake::is_identifier(name)
        {
            names.push(name.to_owned());
        }
    }
    names
}

/// Puts a `let`, `param`, `field` or `region` into a scope; name and earlier place where it is there already.
pub(super) fn declare_binding<'a>(statement: &'a StatementKind, scope: &Scope<'a>) -> Option<(&'a ast::Ident, Span)> {
    let (binding, declared) = match statement {
        StatementKind::Let(binding) => (binding, Declared::Let),
        StatementKind::Field(binding) => (binding, Declared::Field),
        StatementKind::Region(binding) => (binding, Declared::Region),
        StatementKind::Param { binding, domain } => (binding, Declared::Param(domain.as_ref())),
        _ => return None,
    };
    let name = &binding.name;
    scope.declare(&name.name, Binding::Lazy(binding, declared), name.span).map(|earlier| (name, earlier))
}

/// Adds the files and what they import to a survey.
pub(super) fn surveyed(files: Vec<File>, mut survey: Survey) -> Survey {
    for file in &files {
        for &(statement, imported) in &file.imports {
            if let StatementKind::Import { path, .. } = &file.document.statements[statement].kind {
                survey.imports.insert(path.span, files[imported].document.source);
            }
        }
    }
    survey.documents = files.into_iter().map(|file| file.document).collect();
    survey
}

/// Says that a name is declared twice.
pub(super) fn declared_twice(name: &ast::Ident, earlier: Span) -> Diagnostic {
    Diagnostic::error(Code::Duplicate, name.span, format!("`{}` is declared twice", name.name))
        .label("again here")
        .note(earlier, "first declared here")
}

/// Reports names that an import without `as` brings in although they are there already.
fn clashes(modules: &[Module<'_>], index: usize, imported: usize, import: Span, diagnostics: &mut Vec<Diagnostic>) {
    let visible = std::iter::once(index).chain(modules[index].opened.iter().copied());
    let new = &modules[imported];
    for other in visible {
        let other = &modules[other];
        let mut clash = |name: &str, there: Span, here: Span| {
            let message = format!("the import brings in `{name}`, which is there already");
            diagnostics.push(
                Diagnostic::error(Code::Duplicate, import, message)
                    .hint("give the import a name: `import \"…\" as name`")
                    .note(here, "declared here")
                    .note(there, "and here"),
            );
        };
        for name in new.scope.own_names() {
            if let (Some(there), Some(here)) = (new.scope.own(name), other.scope.own(name)) {
                clash(name, there.span, here.span);
            }
        }
        for (name, there) in &new.tones {
            if let Some(here) = other.tones.get(name) {
                clash(name, there.name.span, here.name.span);
            }
        }
        for (name, there) in &new.functions {
            if let Some(here) = other.functions.get(name) {
                clash(name, there.name.span, here.name.span);
            }
        }
    }
}

/// Evaluates every declaration of every file, so that mistakes in what nothing uses are found as well.
pub(super) fn check_declarations(cx: &mut Cx<'_, '_>) {
    let modules = cx.modules;
    // Imports come after the file that imports them; their mistakes are reported at their own places all the same.
    for (index, module) in modules.iter().enumerate() {
        for statement in &module.document.statements {
            match &statement.kind {
                StatementKind::Let(binding)
                | StatementKind::Field(binding)
                | StatementKind::Region(binding)
                | StatementKind::Param { binding, .. } => {
                    names::force(cx, &module.scope, &binding.name.name, binding.name.span);
                }
                StatementKind::Fn { name, params, body } => {
                    function::check_function(cx, Function { module: index, name, params, body });
                }
                StatementKind::Tone { name, params, body } => {
                    tone::check(cx, Tone { module: index, name, params, body });
                }
                _ => {}
            }
        }
    }
    for (index, module) in modules.iter().enumerate() {
        draw::check_order(cx, &module.document.statements, index == 0);
    }
}
