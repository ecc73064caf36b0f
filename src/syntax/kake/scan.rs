//! Words, numbers, strings and signs.
//!
//! In: a text. Out: its tokens and comments in order, and a fault for every string or comment that is not closed. The
//! tokens part the text as the grammar does, so that brackets can be matched and nesting measured before it runs.

use super::{KEYWORDS, MOST_ERRORS, Places};
use crate::diag::{Code, Diagnostic};
use crate::span::Span;
use crate::syntax::ast::{Comment, Doc};
use unicode_ident::{is_xid_continue, is_xid_start};

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A word, also a keyword and `_`.
    Word,
    /// A number with its unit.
    Number,
    /// `#123`
    Colour,
    /// A string without interpolation.
    Text,
    /// The first quote of a string with interpolation.
    TextOpen,
    /// The last quote of a string with interpolation.
    TextClose,
    /// From a quote that is not closed to the end of its line.
    BadText,
    /// `(`, `[`, `{`
    Open,
    /// `)`, `]`, `}`
    Close,
    /// An operator or another sign of the language.
    Sign,
    /// A character that the language does not know.
    Stray,
}

/// A word or sign.
#[derive(Debug, Clone, Copy)]
pub struct Token {
    /// What it is.
    pub kind: Kind,
    /// Its first byte.
    pub start: usize,
    /// One past its last byte.
    pub end: usize,
    /// Whether nothing stands before it on its line.
    pub leads: bool,
}

/// Something that is wrong with the text whatever its grammar.
pub(super) struct Fault {
    /// Where the trouble begins. What the grammar finds wrong from here to the end of the statement follows from it.
    pub(super) at: usize,
    pub(super) diagnostic: Diagnostic,
}

/// A comment, and whether it was found to document something.
struct Remark {
    start: usize,
    end: usize,
    is_taken: bool,
}

/// The comments of a text, and which run of doc comments stands above which token.
#[derive(Default)]
pub(super) struct Remarks {
    list: Vec<Remark>,
    /// Starts of tokens with the doc comments directly above them, as a range of `list`.
    above: Vec<(usize, usize, usize)>,
}

impl Remarks {
    /// The doc comment above the token that starts at `start`. It is then no plain comment any more.
    pub(super) fn take_doc(&mut self, text: &str, places: &Places, start: usize) -> Option<Doc> {
        let found = self.above.binary_search_by_key(&start, |&(token, _, _)| token).ok()?;
        let &(_, first, last) = self.above.get(found)?;
        let run = self.list.get_mut(first..=last)?;
        let span = places.span(run.first()?.start, run.last()?.end);
        let mut lines = Vec::new();
        for remark in run {
            remark.is_taken = true;
            let line = text.get(remark.start + 3..remark.end).unwrap_or_default();
            lines.push(line.strip_prefix(' ').unwrap_or(line));
        }
        Some(Doc { text: lines.join("\n"), span })
    }

    /// Forgets what stands behind `start`, where tokens are taken back.
    fn forget_from(&mut self, start: usize) {
        while self.list.pop_if(|remark| remark.start > start).is_some() {}
        while self.above.pop_if(|(token, _, _)| *token > start).is_some() {}
    }

    /// The comments that document nothing.
    pub(super) fn rest(&self, text: &str, places: &Places) -> Vec<Comment> {
        let free = self.list.iter().filter(|remark| !remark.is_taken);
        free.map(|remark| Comment {
            text: text.get(remark.start..remark.end).unwrap_or_default().to_owned(),
            span: places.span(remark.start, remark.end),
        })
        .collect()
    }
}

/// A string or interpolation that is open where the scanner stands.
struct OpenText {
    /// The token of its first quote.
    token: usize,
    /// Braces that are open inside its interpolation.
    braces: usize,
}

impl Remarks {
    /// Where every comment stands.
    pub(super) fn ranges(&self) -> Vec<std::ops::Range<usize>> {
        self.list.iter().map(|remark| remark.start..remark.end).collect()
    }
}

/// What stopped the text of a string.
enum Stop {
    Quote,
    Brace,
    Line,
}

pub(super) struct Scanner<'t> {
    text: &'t str,
    places: &'t Places<'t>,
    at: usize,
    leads: bool,
    texts: Vec<OpenText>,
    /// The run of doc comments that nothing but white space has followed.
    docs: Option<(usize, usize)>,
    pub(super) tokens: Vec<Token>,
    pub(super) remarks: Remarks,
    pub(super) faults: Vec<Fault>,
}

/// Whether a text is a word of the language.
pub(super) fn is_word(text: &str) -> bool {
    let mut letters = text.chars();
    let begins = match letters.next() {
        Some('_') => letters.next().is_some_and(is_xid_continue),
        Some(first) => is_xid_start(first),
        None => false,
    };
    begins && letters.all(is_xid_continue)
}

/// Whether a text begins a statement.
pub(super) fn is_keyword(text: &str) -> bool {
    KEYWORDS.contains(&text)
}

impl<'t> Scanner<'t> {
    /// Scans a whole text.
    pub(super) fn scan(text: &'t str, places: &'t Places<'t>) -> Self {
        let mut scanner = Self {
            text,
            places,
            at: if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 },
            leads: true,
            texts: Vec::new(),
            docs: None,
            tokens: Vec::new(),
            remarks: Remarks::default(),
            faults: Vec::new(),
        };
        while scanner.step() {}
        scanner
    }

    fn rest(&self) -> &'t str {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Reads white space, a comment or a token; `false` at the end.
    fn step(&mut self) -> bool {
        let rest = self.rest();
        let Some(first) = rest.chars().next() else {
            if self.texts.is_empty() {
                return false;
            }
            self.unclosed_text();
            return true;
        };
        if first.is_whitespace() {
            self.leads |= first == '\n';
            self.at += first.len_utf8();
            if first == '\n' && !self.texts.is_empty() {
                self.unclosed_text();
            }
        } else if rest.starts_with("//") {
            self.line_comment();
        } else if rest.starts_with("/*") {
            self.block_comment();
        } else if first == '"' {
            self.string();
        } else {
            self.token(first);
        }
        true
    }

    fn line_comment(&mut self) {
        let rest = self.rest();
        let length = rest.find('\n').unwrap_or(rest.len());
        let line = rest.get(..length).unwrap_or_default().trim_end();
        let is_doc = line.starts_with("///") && !line.starts_with("////");
        self.remark(line.len(), is_doc);
        self.at += length;
    }

    fn block_comment(&mut self) {
        let rest = self.rest();
        if let Some(inside) = rest.get(2..).and_then(|inside| inside.find("*/")) {
            let length = inside + 4;
            let breaks = rest.get(..length).is_some_and(|comment| comment.contains('\n'));
            self.remark(length, false);
            self.at += length;
            self.leads |= breaks;
            if breaks && !self.texts.is_empty() {
                self.unclosed_text();
            }
        } else {
            let span = self.span(self.at, self.at + 2);
            self.fault(self.at, Diagnostic::error(Code::Syntax, span, "unclosed comment").hint("close it with `*/`"));
            self.at = self.text.len();
        }
    }

    fn remark(&mut self, length: usize, is_doc: bool) {
        let index = self.remarks.list.len();
        self.docs = match self.docs {
            Some((first, _)) if is_doc => Some((first, index)),
            _ if is_doc => Some((index, index)),
            _ => None,
        };
        self.remarks.list.push(Remark { start: self.at, end: self.at + length, is_taken: false });
    }

    fn string(&mut self) {
        let token = self.tokens.len();
        self.push(Kind::TextOpen, 1);
        self.texts.push(OpenText { token, braces: 0 });
        self.inside_text();
        // A string without interpolation is one token.
        if self.tokens.last().is_some_and(|last| last.kind == Kind::TextClose) {
            self.tokens.truncate(token + 1);
            if let Some(opened) = self.tokens.last_mut() {
                (opened.kind, opened.end) = (Kind::Text, self.at);
            }
        }
    }

    /// Goes on after a quote or an interpolation, to the next interpolation or the end of the string.
    fn inside_text(&mut self) {
        match self.text_stop() {
            Stop::Quote => {
                self.texts.pop();
                self.push(Kind::TextClose, 1);
            }
            Stop::Brace => self.push(Kind::Open, 1),
            Stop::Line => self.unclosed_text(),
        }
    }

    fn text_stop(&mut self) -> Stop {
        let bytes = self.text.as_bytes();
        while let Some(&byte) = bytes.get(self.at) {
            match byte {
                b'"' => return Stop::Quote,
                b'{' => return Stop::Brace,
                b'\n' => return Stop::Line,
                b'\\' => self.at += self.escape_length(),
                _ => self.at += 1,
            }
        }
        Stop::Line
    }

    /// How many bytes to pass over at a backslash. They need not end between characters, for none of what stops a
    /// string's text lies inside one.
    fn escape_length(&self) -> usize {
        let bytes = self.text.as_bytes();
        let inside = bytes.get(self.at + 1..).unwrap_or_default();
        if inside.starts_with(b"u{") {
            let text = self.text.get(self.at + 3..).unwrap_or_default();
            let end = text.char_indices().take(11).find(|(_, letter)| matches!(letter, '}' | '"' | '\n'));
            if let Some((length, '}')) = end {
                return length + 4;
            }
        }
        if inside.first().is_none_or(|&byte| byte == b'\n') { 1 } else { 2 }
    }

    /// Gives up on the outermost string that is open: it does not end on its line.
    fn unclosed_text(&mut self) {
        let Some(outermost) = self.texts.first() else { return };
        let token = outermost.token;
        let has_braces = self.tokens.len() > token + 1;
        self.tokens.truncate(token + 1);
        self.texts.clear();
        let Some(quote) = self.tokens.last_mut() else { return };
        let rest = self.text.get(quote.start..).unwrap_or_default();
        let line = rest.get(..rest.find('\n').unwrap_or(rest.len())).unwrap_or_default();
        quote.kind = Kind::BadText;
        quote.end = quote.start + line.trim_end().len();
        let start = quote.start;
        self.at = start + line.len();
        self.leads = false;
        self.remarks.forget_from(start);
        self.docs = None;
        let hint = if has_braces {
            "a string ends with `\"` on the line where it begins, and `{` opens a value inside it: for the brace itself write `\\{`"
        } else {
            "a string ends with `\"` on the line where it begins; `\\n` stands for a line end"
        };
        let span = self.span(start, start + 1);
        self.fault(start, Diagnostic::error(Code::Syntax, span, "unclosed string").label("opened here").hint(hint));
    }

    fn token(&mut self, first: char) {
        let rest = self.rest();
        match first {
            '0'..='9' => {
                let length = number_length(rest);
                self.push(Kind::Number, length);
            }
            '#' => {
                let length = 1 + rest.get(1..).map_or(0, word_length);
                self.push(Kind::Colour, length);
            }
            '(' | '[' => self.push(Kind::Open, 1),
            ')' | ']' => self.push(Kind::Close, 1),
            '{' => {
                if let Some(text) = self.texts.last_mut() {
                    text.braces += 1;
                }
                self.push(Kind::Open, 1);
            }
            '}' => {
                self.push(Kind::Close, 1);
                match self.texts.last_mut() {
                    Some(text) if text.braces > 0 => text.braces -= 1,
                    Some(_) => self.inside_text(),
                    None => {}
                }
            }
            _ if first == '_' || is_xid_start(first) => {
                let length = word_length(rest);
                self.push(Kind::Word, length);
            }
            _ => {
                let is_double = ["..", "==", "!=", "<=", ">=", "=>"].iter().any(|sign| rest.starts_with(sign));
                if is_double {
                    self.push(Kind::Sign, 2);
                } else if ":,=<>+-*/%&^.".contains(first) {
                    self.push(Kind::Sign, 1);
                } else {
                    self.push(Kind::Stray, first.len_utf8());
                }
            }
        }
    }

    fn push(&mut self, kind: Kind, length: usize) {
        if let Some((first, last)) = self.docs.take() {
            self.remarks.above.push((self.at, first, last));
        }
        let end = self.at + length;
        self.tokens.push(Token { kind, start: self.at, end, leads: self.leads });
        self.at = end;
        self.leads = false;
    }

    fn span(&self, start: usize, end: usize) -> Span {
        self.places.span(start, end)
    }

    fn fault(&mut self, at: usize, diagnostic: Diagnostic) {
        if self.faults.len() < MOST_ERRORS {
            self.faults.push(Fault { at, diagnostic });
        }
    }
}

/// How many bytes of word letters a text begins with.
fn word_length(text: &str) -> usize {
    text.find(|letter| !is_xid_continue(letter)).unwrap_or(text.len())
}

fn digits_length(bytes: &[u8]) -> usize {
    bytes.iter().take_while(|byte| byte.is_ascii_digit()).count()
}

/// How many bytes the number has that a text begins with, and its unit.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let from = |at: usize| bytes.get(at..).unwrap_or_default();
    let mut length = digits_length(bytes);
    if let Some(b'.') = from(length).first() {
        let digits = digits_length(from(length + 1));
        length += if digits > 0 { 1 + digits } else { 0 };
    }
    if let Some(b'e' | b'E') = from(length).first() {
        let sign = usize::from(matches!(from(length + 1).first(), Some(b'+' | b'-')));
        let digits = digits_length(from(length + 1 + sign));
        length += if digits > 0 { 1 + sign + digits } else { 0 };
    }
    let rest = text.get(length..).unwrap_or_default();
    match rest.chars().next() {
        Some('%') if !rest.chars().nth(1).is_some_and(is_xid_continue) => length + 1,
        Some(letter) if letter == '_' || is_xid_start(letter) => length + word_length(rest),
        _ => length,
    }
}
