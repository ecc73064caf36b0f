//! Brackets, nesting, and where statements and properties begin.
//!
//! In: tokens. Out: each bracket's partner, the places where nesting passes the limit, the tokens at which a statement
//! or property begins, and a fault for every bracket that has no partner. On a text without mistakes the beginnings
//! are exact: a keyword that stands where an operator or an end is due begins a statement. On others a keyword that
//! leads its line and is followed as a statement would be closes the brackets that were forgotten before it
//! ([`repair`]).

mod repair;

use super::scan::{Fault, Kind, Token, is_keyword};
use super::{KEYWORDS, NESTING, Places, RESERVED, near_word};
use repair::bracket_kind;

/// What a pair of brackets holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// Statements: a file, or the block of `layer`, `for` and `if`.
    Statements,
    /// Properties: a block or a record.
    Properties,
    /// Values, arguments, or the arms of a `match`.
    Values,
    /// The inside of a string.
    Text,
}

/// What is known of a token beside its kind.
#[derive(Debug, Clone, Copy)]
pub(super) struct Role {
    /// For an opening bracket the closing one, or the token before which it must end if that is missing.
    pub(super) mate: usize,
    /// Whether the bracket has a partner.
    pub(super) is_matched: bool,
    /// Whether a statement or property begins here.
    pub(super) begins: bool,
    /// For the brace that opens a statement's own block: what it holds.
    pub(super) block: Option<Shape>,
}

/// The structure of a text.
pub(super) struct Structure {
    /// For each token.
    pub(super) roles: Vec<Role>,
    /// The tokens at which nesting passes the limit, in order.
    pub(super) too_deep: Vec<usize>,
    /// What is wrong with the brackets.
    pub(super) faults: Vec<Fault>,
    /// How many brackets have no partner.
    lost: usize,
}

/// A condition or match whose end has not come; the grammar recurses for each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pending {
    /// `if` before its `then`
    Condition,
    /// behind `then`
    Then,
    /// behind the `else` of an `if … then`
    Else,
    /// `match` before its brace
    Match,
}

/// An open pair of brackets.
struct Frame {
    /// The token that opened it; none for the text itself.
    open: Option<usize>,
    shape: Shape,
    /// Whether its brace is a statement's block.
    is_block: bool,
    /// How many pending things belong to the frames around it.
    outer: usize,
    /// How many of its pending things are matches.
    matches: usize,
    /// Whether a statement or property must begin here.
    is_fresh: bool,
    /// Whether a value must follow.
    wants_value: bool,
    /// The statement's keyword, in a frame of statements.
    keyword: &'static str,
    /// Whether the `seed` of a `paint` has come.
    has_seed: bool,
    /// How far the statement's first word is indented.
    indent: usize,
    /// Whether an unclosed string stands in it: the bracket's partner may have been taken for its text.
    has_bad_text: bool,
    /// The open brackets of each kind around the string that this frame is.
    counts: [usize; 3],
}

/// Whether the way in which lines are broken and indented says where brackets end.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Layout {
    Ignored,
    Heeded,
}

/// Finds the structure of a text. `shape` is what the whole of it holds.
pub(super) fn structure(text: &str, tokens: &[Token], shape: Shape, places: &Places) -> Structure {
    let plain = Builder::run(text, tokens, shape, places, Layout::Ignored);
    if plain.lost == 0 {
        return plain;
    }
    // A bracket that is missing is missed far behind the place, a brace at the end of the file. Where the lines are set
    // as is usual, they tell the statement or property behind which it is missing.
    let guided = Builder::run(text, tokens, shape, places, Layout::Heeded);
    if guided.lost <= plain.lost { guided } else { plain }
}

struct Builder<'a> {
    text: &'a str,
    tokens: &'a [Token],
    places: &'a Places<'a>,
    layout: Layout,
    frames: Vec<Frame>,
    pending: Vec<Pending>,
    brackets: usize,
    /// Open brackets of each kind since the innermost string began.
    counts: [usize; 3],
    is_too_deep: bool,
    found: Structure,
}

/// The keyword that a word is or was meant to be.
fn keyword_near(word: &str) -> &'static str {
    let exact = KEYWORDS.iter().copied().find(|&keyword| keyword == word);
    let near = || {
        let hint = near_word(word, KEYWORDS)?;
        KEYWORDS.iter().copied().find(|keyword| hint.contains(&format!("`{keyword}`")))
    };
    exact.or_else(near).unwrap_or_default()
}

impl<'a> Builder<'a> {
    fn run(text: &'a str, tokens: &'a [Token], shape: Shape, places: &'a Places<'a>, layout: Layout) -> Structure {
        let role = Role { mate: tokens.len(), is_matched: false, begins: false, block: None };
        let mut builder = Self {
            text,
            tokens,
            places,
            layout,
            frames: vec![Frame::new(None, shape, 0)],
            pending: Vec::new(),
            brackets: 0,
            counts: [0; 3],
            is_too_deep: false,
            found: Structure { roles: vec![role; tokens.len()], too_deep: Vec::new(), faults: Vec::new(), lost: 0 },
        };
        for (index, token) in tokens.iter().enumerate() {
            builder.step(index, token);
        }
        builder.unclosed(1, tokens.len());
        builder.found
    }

    fn step(&mut self, index: usize, token: &Token) {
        match token.kind {
            Kind::Word => self.word(index, token),
            Kind::Number | Kind::Colour | Kind::Text => self.value(index),
            Kind::BadText => {
                self.value(index);
                if let Some(frame) = self.frames.last_mut() {
                    frame.has_bad_text = true;
                }
            }
            Kind::Sign => self.sign(index),
            Kind::Stray => self.begin_if_fresh(index),
            Kind::Open | Kind::TextOpen => self.open(index, token),
            Kind::Close | Kind::TextClose => self.close(index),
        }
    }

    fn text_of(&self, index: usize) -> &'a str {
        self.tokens.get(index).and_then(|token| self.text.get(token.start..token.end)).unwrap_or_default()
    }

    fn kind_of(&self, index: usize) -> Option<Kind> {
        self.tokens.get(index).map(|token| token.kind)
    }

    /// How far the line is indented on which a token stands first; the column of any other.
    fn column(&self, index: usize) -> usize {
        let start = self.tokens.get(index).map_or(0, |token| token.start);
        let before = self.text.get(..start).unwrap_or_default();
        // Only white space is counted, so that the work stays linear on a text of one long line.
        before.bytes().rev().take_while(|byte| matches!(byte, b' ' | b'\t')).count()
    }

    fn begin(&mut self, index: usize) {
        let word = self.text_of(index);
        let (indent, keyword) = (self.column(index), keyword_near(word));
        let is_alone = keyword != word && self.tokens.get(index + 1).is_none_or(|next| next.leads);
        let Some(frame) = self.frames.last_mut() else { return };
        self.pending.truncate(frame.outer);
        frame.matches = 0;
        frame.is_fresh = false;
        // A word that is no keyword stands in a keyword's place, but the next line is not taken for part of it.
        frame.wants_value = frame.shape == Shape::Properties || !is_alone;
        if frame.shape == Shape::Statements {
            (frame.keyword, frame.has_seed, frame.indent) = (keyword, false, indent);
        }
        if let Some(role) = self.found.roles.get_mut(index) {
            role.begins = true;
        }
        self.measure(index);
    }

    fn begin_if_fresh(&mut self, index: usize) {
        let begins = |frame: &Frame| frame.is_fresh && matches!(frame.shape, Shape::Statements | Shape::Properties);
        if self.frames.last().is_some_and(begins) {
            self.begin(index);
        }
    }

    /// Notes where nesting passes the limit.
    fn measure(&mut self, index: usize) {
        let is_too_deep = self.brackets + self.pending.len() > NESTING;
        if is_too_deep && !self.is_too_deep {
            self.found.too_deep.push(index);
        }
        self.is_too_deep = is_too_deep;
    }

    fn value(&mut self, index: usize) {
        self.begin_if_fresh(index);
        if let Some(frame) = self.frames.last_mut() {
            frame.wants_value = false;
        }
    }

    fn sign(&mut self, index: usize) {
        self.begin_if_fresh(index);
        let sign = self.text_of(index);
        let Some(frame) = self.frames.last_mut() else { return };
        frame.wants_value = true;
        // A comma ends a value, an arrow the pattern before it.
        if matches!(sign, "," | "=>") {
            self.pending.truncate(frame.outer);
            frame.matches = 0;
            frame.is_fresh = frame.shape == Shape::Properties && sign == ",";
            self.measure(index);
        }
    }

    fn word(&mut self, index: usize, token: &Token) {
        let word = self.text_of(index);
        let is_start = token.leads && is_keyword(word) && self.is_followed_as_statement(index, word);
        if is_start {
            self.close_forgotten(index, word);
        } else if token.leads && self.text_of(index + 1) == ":" {
            self.close_before_property(index);
        }
        let Some(frame) = self.frames.last() else { return };
        match frame.shape {
            Shape::Statements => self.word_of_statement(index, token, is_start),
            Shape::Properties => {
                let leads_property =
                    token.leads && !frame.wants_value && !matches!(word, "and" | "or" | "then" | "else");
                if self.text_of(index + 1) == ":" || leads_property || frame.is_fresh {
                    self.begin(index);
                    if let Some(frame) = self.frames.last_mut() {
                        frame.wants_value = false;
                    }
                } else {
                    self.word_of_value(index, word);
                }
            }
            Shape::Values | Shape::Text => self.word_of_value(index, word),
        }
    }

    fn word_of_statement(&mut self, index: usize, token: &Token, is_start: bool) {
        let word = self.text_of(index);
        let Some(frame) = self.frames.last_mut() else { return };
        if frame.is_fresh {
            self.begin(index);
        } else if !frame.wants_value {
            if word == "seed" && frame.keyword == "paint" && !frame.has_seed {
                (frame.has_seed, frame.wants_value) = (true, true);
            } else if word == "ink" && frame.keyword == "layer" {
                frame.wants_value = true;
            } else if is_keyword(word) {
                self.begin(index);
            } else if matches!(word, "with" | "as" | "in" | "pen") {
                frame.wants_value = true;
            } else if RESERVED.contains(&word) {
                self.word_of_value(index, word);
            } else if token.leads {
                let indent = frame.indent;
                if self.column(index) <= indent {
                    self.begin(index);
                }
            }
        } else if is_start && !(word == "canvas" && matches!(frame.keyword, "if" | "for" | "layer")) {
            self.begin(index);
        } else {
            self.word_of_value(index, word);
        }
    }

    fn word_of_value(&mut self, index: usize, word: &str) {
        let is_label = self.text_of(index + 1) == ":";
        let follows_else = index > 0 && self.text_of(index - 1) == "else";
        let Some(frame) = self.frames.last_mut() else { return };
        let outer = frame.outer;
        frame.wants_value = !is_label && matches!(word, "if" | "match" | "not" | "and" | "or" | "then" | "else");
        if !frame.wants_value {
            return;
        }
        match word {
            "if" if follows_else => {
                if self.pending.len() > outer
                    && let Some(last) = self.pending.last_mut()
                {
                    *last = Pending::Condition;
                }
            }
            "if" => self.pending.push(Pending::Condition),
            "match" => {
                frame.matches += 1;
                self.pending.push(Pending::Match);
            }
            "then" => self.advance(Pending::Condition, Pending::Then),
            "else" => self.advance(Pending::Then, Pending::Else),
            _ => {}
        }
        self.measure(index);
    }

    /// Ends what is pending inside the nearest `if` that stands at `from`, and moves that on.
    fn advance(&mut self, from: Pending, to: Pending) {
        let Some(frame) = self.frames.last_mut() else { return };
        while self.pending.len() > frame.outer
            && let Some(last) = self.pending.last_mut()
        {
            if *last == from {
                *last = to;
                return;
            }
            frame.matches -= usize::from(*last == Pending::Match);
            self.pending.pop();
        }
    }

    fn open(&mut self, index: usize, token: &Token) {
        self.begin_if_fresh(index);
        let bracket = self.text_of(index);
        let (shape, is_block) = if token.kind == Kind::TextOpen {
            (Shape::Text, false)
        } else if bracket == "{" {
            self.brace_shape(index)
        } else {
            (Shape::Values, false)
        };
        if is_block && let Some(role) = self.found.roles.get_mut(index) {
            role.block = Some(shape);
            self.pending.truncate(self.frames.last().map_or(0, |frame| frame.outer));
        }
        let mut frame = Frame::new(Some(index), shape, self.pending.len());
        frame.is_block = is_block;
        if let Some(kind) = bracket_kind(bracket) {
            self.brackets += 1;
            if let Some(count) = self.counts.get_mut(kind) {
                *count += 1;
            }
        } else {
            frame.counts = std::mem::take(&mut self.counts);
        }
        self.frames.push(frame);
        self.measure(index);
    }

    /// What a brace holds, and whether it is a statement's block.
    fn brace_shape(&mut self, index: usize) -> (Shape, bool) {
        let follows_else = index > 0 && self.text_of(index - 1) == "else";
        let is_record = self.text_of(index + 1) == "}" || self.text_of(index + 2) == ":";
        let Some(frame) = self.frames.last_mut() else { return (Shape::Values, false) };
        if frame.shape == Shape::Text {
            return (Shape::Values, false);
        }
        let (outer, wants_value) = (frame.outer, frame.wants_value);
        if frame.matches > 0 && !wants_value {
            // The brace of the nearest match, whose subject ends here.
            frame.matches -= 1;
            while self.pending.len() > outer && self.pending.pop() != Some(Pending::Match) {}
            return (Shape::Values, false);
        }
        if frame.shape != Shape::Statements {
            return (Shape::Properties, false);
        }
        match frame.keyword {
            "canvas" | "tone" | "experiment" => (Shape::Properties, true),
            // Where a value is missing before it, the block is still no record.
            "layer" | "for" if !wants_value || !is_record => (Shape::Statements, true),
            "if" if !wants_value || !is_record || (follows_else && self.pending.len() == outer) => {
                (Shape::Statements, true)
            }
            _ => (Shape::Properties, false),
        }
    }

    /// Pops the innermost frame, which ends at token `end`.
    fn pop(&mut self, end: usize, is_matched: bool) {
        let Some(frame) = self.frames.pop() else { return };
        let Some(open) = frame.open else { return };
        self.pending.truncate(frame.outer);
        if let Some(role) = self.found.roles.get_mut(open) {
            (role.mate, role.is_matched) = (end, is_matched);
        }
        if is_matched && let Some(role) = self.found.roles.get_mut(end) {
            (role.mate, role.is_matched) = (open, true);
        }
        if let Some(kind) = bracket_kind(self.text_of(open)) {
            self.brackets -= 1;
            if let Some(count) = self.counts.get_mut(kind) {
                *count -= 1;
            }
        } else {
            self.counts = frame.counts;
        }
        let goes_on = self.text_of(end + usize::from(is_matched)) == "else";
        if let Some(around) = self.frames.last_mut() {
            around.wants_value = false;
            around.has_bad_text |= frame.has_bad_text;
            if frame.is_block {
                around.is_fresh = !(around.keyword == "if" && goes_on);
            }
        }
        self.measure(end);
    }
}

impl Frame {
    fn new(open: Option<usize>, shape: Shape, outer: usize) -> Self {
        Self {
            open,
            shape,
            is_block: false,
            outer,
            matches: 0,
            is_fresh: true,
            wants_value: true,
            keyword: "",
            has_seed: false,
            indent: 0,
            has_bad_text: false,
            counts: [0; 3],
        }
    }
}
