//! The brackets and blocks around a place, and how far what is written in each has come.

use crate::lower::reference::{Block, Kind, Slot};

/// What is called, as it is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Called<'t> {
    /// The module before the point.
    pub module: Option<&'t str>,
    /// The name.
    pub name: &'t str,
}

/// Which argument of a call is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Argument<'t> {
    /// The one of this name.
    Named(&'t str),
    /// The one at this place, from 0.
    Place(usize),
}

/// What is inside what.
#[derive(Debug, Clone, Copy)]
pub(super) enum Inside<'t> {
    /// Statements of a file or block.
    Statements { is_top: bool },
    /// Properties of a block.
    Properties(Block),
    /// Members of a record.
    Record,
    /// A value inside a string.
    Interpolation,
    /// Arguments of a call, whose own place takes `slot`.
    Call { called: Called<'t>, slot: Slot },
    /// Parameters that are being declared.
    Parameters,
    /// A group, tuple, list or index.
    Group,
    /// Arms of a match.
    Arms,
    /// Text with interpolations.
    Text,
}

/// What comes next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Expects<'t> {
    Statement,
    /// A label, or in a call a value.
    Label,
    Colon,
    /// A name that is declared.
    Name,
    /// `:`, `=`, `(`, `{` or `in`.
    AfterName,
    Type,
    Member(&'t str),
    Operand,
    /// An operator, or an end.
    After,
}

/// One level of brackets.
#[derive(Debug)]
pub(super) struct Frame<'t> {
    pub(super) inside: Inside<'t>,
    pub(super) expects: Expects<'t>,
    /// What the place of the value takes that is being written.
    pub(super) slot: Slot,
    /// What the operand takes.
    pub(super) here: Slot,
    /// The property, argument or statement that takes the value.
    pub(super) owner: Option<&'t str>,
    /// The statement that is being written.
    pub(super) head: Option<&'static str>,
    pub(super) label: Option<&'t str>,
    pub(super) labels: Vec<&'t str>,
    /// How many arguments stand before this one.
    count: usize,
    /// The name that was read last, where it may be called.
    pub(super) last: Option<Called<'t>>,
    /// The type that the declared name is pinned to.
    pub(super) pinned: Option<Kind>,
    pub(super) is_match: bool,
    /// Names that are seen here, with where they stand.
    pub(super) names: Vec<(&'t str, usize)>,
    /// Names that will be seen in the block or value that follows.
    pub(super) pending: Vec<(&'t str, usize)>,
}

impl<'t> Frame<'t> {
    pub(super) fn new(inside: Inside<'t>, slot: Slot) -> Self {
        let expects = match inside {
            Inside::Statements { .. } => Expects::Statement,
            Inside::Properties(_) | Inside::Record => Expects::Label,
            Inside::Parameters => Expects::Name,
            Inside::Call { .. } | Inside::Group | Inside::Arms | Inside::Text | Inside::Interpolation => {
                Expects::Operand
            }
        };
        Self {
            inside,
            expects,
            slot,
            here: slot,
            owner: None,
            head: None,
            label: None,
            labels: Vec::new(),
            count: 0,
            last: None,
            pinned: None,
            is_match: false,
            names: Vec::new(),
            pending: Vec::new(),
        }
    }

    /// A statement begins.
    pub(super) fn begin(&mut self, keyword: &'static str) {
        self.end_of_statement();
        self.head = Some(keyword);
        let region = Slot::of(Kind::Region);
        match keyword {
            "edition" | "seed" => self.value(Slot::of(Kind::Number), Some(keyword)),
            "canvas" => self.expects = Expects::AfterName,
            "paint" | "outline" => self.value(region, Some(keyword)),
            "ink" => self.value(Slot::of(Kind::Drawing), Some(keyword)),
            "layer" | "import" => self.value(Slot::of(Kind::String), Some(keyword)),
            "if" => self.value(Slot::ANY, None),
            _ => self.expects = Expects::Name,
        }
    }

    /// A statement is whole, as far as its block is.
    pub(super) fn end_of_statement(&mut self) {
        self.expects = Expects::Statement;
        self.owner = None;
        self.last = None;
        self.pinned = None;
        self.is_match = false;
        self.pending.clear();
        self.slot = Slot::ANY;
        self.here = Slot::ANY;
        // An `else` may follow.
        self.head = self.head.filter(|head| *head == "if");
    }

    /// A value begins, in a place of its own.
    pub(super) fn value(&mut self, slot: Slot, owner: Option<&'t str>) {
        self.slot = slot;
        self.owner = owner;
        self.again(slot);
    }

    /// A further operand of the value at hand begins.
    pub(super) fn again(&mut self, slot: Slot) {
        self.here = slot;
        self.last = None;
        self.expects = Expects::Operand;
    }

    /// A name is declared.
    pub(super) fn name(&mut self, word: &'t str, start: usize) {
        self.expects = Expects::AfterName;
        self.pinned = None;
        match (self.inside, self.head) {
            (Inside::Parameters, _) => self.names.push((word, start)),
            (_, Some("for")) => self.pending.push((word, start)),
            (_, Some("let" | "field" | "region")) => self.names.push((word, start)),
            _ => {}
        }
    }

    /// Behind `=`.
    pub(super) fn assigned(&mut self) {
        let slot = match (self.pinned, self.head) {
            (Some(kind), _) => Slot::of(kind),
            (None, Some("field")) => Slot::of(Kind::Field),
            (None, Some("region")) => Slot::of(Kind::Region),
            (None, Some("tone")) => Slot::of(Kind::Tone),
            _ => Slot::ANY,
        };
        if self.expects == Expects::AfterName {
            let pinned = self.pinned;
            self.value(slot, None);
            self.pinned = pinned;
        }
    }

    /// A label is read.
    pub(super) fn label(&mut self, word: &'t str) {
        if !matches!(self.inside, Inside::Call { .. }) {
            self.labels.push(word);
        }
        self.label = Some(word);
        self.last = None;
        self.expects = Expects::Colon;
    }

    /// Behind a comma of a call.
    pub(super) fn next_argument(&mut self) {
        self.count += 1;
        self.label = None;
        self.last = None;
        self.expects = Expects::Label;
    }

    /// Which argument is at hand. Those that are given by name take no place.
    pub(super) fn argument(&self) -> Argument<'t> {
        match self.label {
            Some(label) => Argument::Named(label),
            None => Argument::Place(self.count),
        }
    }

    /// What the place of a call that stands here takes.
    pub(super) fn called_slot(&self) -> Slot {
        self.here
    }

    /// Whether the tone of a paint was named.
    pub(super) fn is_painted(&self) -> bool {
        matches!(self.owner, Some("with" | "as" | "seed"))
    }
}
