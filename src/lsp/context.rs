//! What may stand at a place of a text that is being written.
//!
//! In: a text, half-typed as it may be, and a byte of it. Out: a [`Context`]: which word stands there, what its place
//! takes, which call it is in and which names are declared around it. The tokens from the statement's beginning up to
//! the place are followed once; nothing is parsed, so nothing need be whole.

use std::ops::Range;

use crate::lower::reference::{self, Block, Kind, Slot};
use crate::syntax::kake::{self, KEYWORDS, RESERVED, Token, TokenKind};

use super::frame::{Argument, Called, Expects, Frame, Inside};

/// What stands and may stand at a place.
#[derive(Debug)]
pub struct Context<'t> {
    /// The word, number or string that the place lies in or directly behind; empty where there is none.
    pub word: Range<usize>,
    /// What may stand there.
    pub place: Place<'t>,
    /// The calls around the place, outermost first.
    pub calls: Vec<CallAt<'t>>,
    /// Names that are declared around the place, inside its statement, and where.
    pub locals: Vec<(&'t str, usize)>,
    /// Names of properties that the block around the place has already.
    pub given: Vec<&'t str>,
    /// Whether the word is the first of its line.
    pub leads: bool,
}

/// A call that a place lies in.
#[derive(Debug, Clone)]
pub struct CallAt<'t> {
    /// What is called.
    pub called: Called<'t>,
    /// What the call's own place takes.
    pub slot: Slot,
    /// The names of the arguments that are given by name before the place.
    pub labels: Vec<&'t str>,
    /// Which of the call's parameters the place belongs to.
    pub argument: Argument<'t>,
}

/// What may stand at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place<'t> {
    /// Nothing that could be told: a comment, a name that is being declared.
    Nothing,
    /// A statement, at the top level of a file or in a block.
    Statement {
        /// Whether at the top level.
        is_top: bool,
        /// The statement that could go on instead.
        head: Option<&'t str>,
    },
    /// The name of a property of a block.
    Property(Block),
    /// The name of an argument of the innermost call, or its value.
    Argument,
    /// A value.
    Value {
        /// The property, argument or statement that takes it.
        owner: Option<&'t str>,
    },
    /// Text inside a string that is a value.
    Text {
        /// The property, argument or statement that takes it.
        owner: Option<&'t str>,
    },
    /// A member of a module.
    Member(&'t str),
    /// A type.
    Type,
    /// What joins or ends a value.
    Operator {
        /// The statement that could go on.
        head: Option<&'t str>,
    },
}

/// A context with what its value takes.
#[derive(Debug)]
pub struct Found<'t> {
    /// The context.
    pub context: Context<'t>,
    /// What a value at the place has to be.
    pub slot: Slot,
}

/// What is known of the functions and tones of a scene.
pub trait Known {
    /// The names of what a function or tone takes, each with its slot.
    fn parameters(&self, called: &Called<'_>, slot: Slot) -> Option<Vec<(String, Slot)>>;
}

/// Says what may stand at a byte of a text.
#[must_use]
pub fn context<'t>(text: &'t str, offset: usize, known: &dyn Known) -> Found<'t> {
    let begin = statement_start(text, offset);
    let rest = text.get(begin..).unwrap_or_default();
    // What follows the place's line plays no part, but for the word it lies in.
    let line_end = rest.get(offset - begin..).and_then(|after| after.find('\n')).map(|at| offset - begin + at);
    let (tokens, comments) = kake::tokens(rest.get(..line_end.unwrap_or(rest.len())).unwrap_or_default());
    let at = offset - begin;
    let mut walk = Walk { text: rest, known, frames: vec![Frame::new(Inside::Statements { is_top: true }, Slot::ANY)] };
    let current = tokens.iter().position(|token| {
        let touches = token.start < at && at <= token.end;
        let is_word = matches!(token.kind, TokenKind::Word | TokenKind::Number | TokenKind::Colour);
        let starts_here = token.start == at && is_word;
        let inside_text = token.start < at && at < token.end;
        let is_open_text = token.kind == TokenKind::BadText && touches;
        (is_word && touches) || starts_here || (matches!(token.kind, TokenKind::Text) && inside_text) || is_open_text
    });
    let before = tokens.iter().enumerate().filter(|(i, token)| Some(*i) != current && token.end <= at);
    for (i, _) in before {
        walk.token(&tokens, i);
    }
    let token = current.and_then(|i| tokens.get(i));
    let word = token.map_or(offset..offset, |token| begin + token.start..begin + token.end);
    let in_comment = comments.iter().any(|range| range.start < at && at <= range.end);
    let in_text = token.is_some_and(|token| matches!(token.kind, TokenKind::Text | TokenKind::BadText));
    let leads = match token {
        Some(token) => token.leads,
        None => text
            .get(..offset)
            .is_some_and(|before| before.rsplit('\n').next().is_some_and(|line| line.trim().is_empty())),
    };
    let is_label = current.and_then(|i| tokens.get(i + 1)).is_some_and(|next| walk.is_sign(next, ":"));
    let (place, slot) = match in_comment {
        true => (Place::Nothing, Slot::ANY),
        false => walk.place(in_text, leads, is_label),
    };
    let given = walk.frames.last().map(|frame| frame.labels.clone()).unwrap_or_default();
    let context = Context { word, place, calls: walk.calls(), locals: walk.locals(begin), given, leads };
    Found { context, slot }
}

/// Where the statement begins that a byte lies in: at the last keyword that opens a line before it.
fn statement_start(text: &str, offset: usize) -> usize {
    let mut end = offset.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    loop {
        let start = text.get(..end).and_then(|before| before.rfind('\n')).map_or(0, |at| at + 1);
        let line = text.get(start..).unwrap_or_default();
        let line = line.get(..line.find('\n').unwrap_or(line.len())).unwrap_or_default();
        let length = line.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(line.len());
        let word = line.get(..length).unwrap_or_default();
        let follows = line.get(length..).unwrap_or_default().trim_start();
        // `field: 3` in a block that is not indented is a property.
        if start == 0 || (KEYWORDS.contains(&word) && !follows.starts_with([':', ',', ')', '(', '.'])) {
            return start;
        }
        end = start - 1;
    }
}

struct Walk<'t, 'k> {
    text: &'t str,
    known: &'k dyn Known,
    frames: Vec<Frame<'t>>,
}

impl<'t> Walk<'t, '_> {
    fn text_of(&self, token: &Token) -> &'t str {
        self.text.get(token.start..token.end).unwrap_or_default()
    }

    fn is_sign(&self, token: &Token, sign: &str) -> bool {
        token.kind == TokenKind::Sign && self.text_of(token) == sign
    }

    fn top(&mut self) -> Option<&mut Frame<'t>> {
        self.frames.last_mut()
    }

    fn token(&mut self, tokens: &[Token], i: usize) {
        let Some(token) = tokens.get(i) else { return };
        let text = self.text_of(token);
        match token.kind {
            TokenKind::Word => {
                let next_is_colon = tokens.get(i + 1).is_some_and(|next| self.is_sign(next, ":"));
                self.word(text, token, next_is_colon);
            }
            TokenKind::Number | TokenKind::Colour | TokenKind::Text | TokenKind::BadText => self.operand(None),
            TokenKind::TextOpen => {
                self.operand(None);
                self.frames.push(Frame::new(Inside::Text, Slot::ANY));
            }
            TokenKind::TextClose => self.close_to(|inside| matches!(inside, Inside::Text)),
            TokenKind::Open => self.open(text),
            TokenKind::Close => self.close(text),
            TokenKind::Sign => self.sign(text),
            TokenKind::Stray => {}
        }
    }

    /// A value that is whole, a name with its path.
    fn operand(&mut self, called: Option<Called<'t>>) {
        if let Some(frame) = self.top() {
            frame.last = called;
            if matches!(frame.expects, Expects::Operand | Expects::Label) {
                frame.expects = Expects::After;
            }
        }
    }

    fn word(&mut self, word: &'t str, token: &Token, is_label: bool) {
        let start = token.start;
        let Some(frame) = self.frames.last_mut() else { return };
        match frame.expects {
            Expects::Statement => self.statement(word),
            Expects::Label if is_label || matches!(frame.inside, Inside::Properties(_)) => frame.label(word),
            Expects::Name => {
                frame.name(word, start);
            }
            Expects::AfterName if word == "in" && frame.head == Some("for") => frame.value(Slot::ANY, None),
            Expects::AfterName if KEYWORDS.contains(&word) && token.leads => self.statement(word),
            Expects::AfterName => {}
            Expects::Type => {
                frame.pinned = Kind::from_name(word);
                frame.expects = Expects::AfterName;
            }
            Expects::Member(module) => {
                frame.expects = Expects::Operand;
                self.operand(Some(Called { module: Some(module), name: word }));
            }
            Expects::Colon => {}
            Expects::Operand | Expects::Label => match word {
                "not" | "if" => {}
                "match" => frame.is_match = true,
                "true" | "false" => self.operand(None),
                _ => self.operand(Some(Called { module: None, name: word })),
            },
            Expects::After => self.clause(word, token, is_label),
        }
    }

    /// A word behind a value.
    fn clause(&mut self, word: &'t str, token: &Token, is_label: bool) {
        let Some(frame) = self.frames.last_mut() else { return };
        match (word, frame.head) {
            ("and" | "or", _) => frame.again(Slot::ANY),
            ("then" | "else", _) if !matches!(frame.inside, Inside::Statements { .. }) || frame.head != Some("if") => {
                let slot = frame.slot;
                frame.again(slot);
            }
            ("with", Some("paint")) => frame.value(Slot::of(Kind::Tone), Some("with")),
            ("with", Some("tone")) => frame.expects = Expects::AfterName,
            ("as", Some("paint")) => frame.value(Slot::of(Kind::String), Some("as")),
            ("as", Some("import")) => frame.expects = Expects::Name,
            ("seed", Some("paint")) if !token.leads || frame.is_painted() => {
                frame.value(Slot::of(Kind::Number), Some("seed"));
            }
            ("pen", Some("outline")) => frame.value(Slot::of(Kind::Length), Some("pen")),
            ("ink", Some("layer")) => frame.value(Slot::of(Kind::Colour), Some("ink")),
            ("in", Some("param")) => frame.value(frame.pinned.map_or(Slot::ANY, Slot::of), Some("in")),
            _ => match frame.inside {
                Inside::Statements { .. } if KEYWORDS.contains(&word) => self.statement(word),
                Inside::Properties(_) | Inside::Record => frame.label(word),
                Inside::Call { .. } if is_label => frame.label(word),
                _ => {}
            },
        }
    }

    fn statement(&mut self, word: &'t str) {
        let Some(frame) = self.top() else { return };
        if word == "else" {
            frame.head = Some("if");
            frame.expects = Expects::AfterName;
            return;
        }
        let Some(&keyword) = KEYWORDS.iter().find(|known| **known == word) else { return };
        frame.begin(keyword);
    }

    fn open(&mut self, sign: &str) {
        let Some(frame) = self.frames.last_mut() else { return };
        let slot = frame.here;
        let next = match (sign, frame.expects) {
            _ if matches!(frame.inside, Inside::Text) => Frame::new(Inside::Interpolation, Slot::ANY),
            ("(", Expects::AfterName) => Frame::new(Inside::Parameters, Slot::ANY),
            ("(", Expects::After) => match frame.last.take() {
                Some(called) => {
                    let place = frame.called_slot();
                    let mut inner = Frame::new(Inside::Call { called, slot: place }, Slot::ANY);
                    inner.expects = Expects::Label;
                    self.frames.push(inner);
                    self.argument();
                    return;
                }
                None => Frame::new(Inside::Group, Slot::ANY),
            },
            ("(", _) => {
                // The members of points and boxes are lengths.
                let inner = match slot.kind {
                    Some(Kind::Point | Kind::Box) => Slot::of(Kind::Length),
                    _ => slot,
                };
                Frame::new(Inside::Group, inner)
            }
            ("[", Expects::After) => Frame::new(Inside::Group, Slot::of(Kind::Number)),
            ("[", _) => {
                let inner = if slot.kind == Some(Kind::List) { Slot::ANY } else { slot };
                let mut list = Frame::new(Inside::Group, inner);
                list.owner = frame.owner;
                list
            }
            (_, Expects::After) if frame.is_match => {
                frame.is_match = false;
                let mut arms = Frame::new(Inside::Arms, slot);
                arms.owner = frame.owner;
                arms.expects = Expects::After;
                arms
            }
            (_, Expects::After | Expects::AfterName | Expects::Statement) => match frame.head {
                Some("tone") => Frame::new(Inside::Properties(Block::Tone), Slot::ANY),
                Some("canvas") => Frame::new(Inside::Properties(Block::Canvas), Slot::ANY),
                Some("experiment") => Frame::new(Inside::Properties(Block::Experiment), Slot::ANY),
                _ => {
                    let mut block = Frame::new(Inside::Statements { is_top: false }, Slot::ANY);
                    // A loop's variable is seen inside its block alone.
                    block.names.append(&mut frame.pending);
                    block
                }
            },
            _ => Frame::new(Inside::Record, Slot::ANY),
        };
        let mut next = next;
        // The parameters of a tone are seen in its properties.
        if matches!(next.inside, Inside::Properties(_)) {
            next.names.append(&mut frame.pending);
        }
        self.frames.push(next);
    }

    fn close(&mut self, sign: &str) {
        let fits = |inside: &Inside<'_>| match inside {
            Inside::Statements { is_top } => sign == "}" && !is_top,
            Inside::Properties(_) | Inside::Record | Inside::Interpolation | Inside::Arms => sign == "}",
            Inside::Call { .. } | Inside::Parameters => sign == ")",
            Inside::Group => sign != "}",
            Inside::Text => false,
        };
        self.close_to(fits);
    }

    /// Leaves the innermost frame that fits, and those inside it; none where none fits.
    fn close_to(&mut self, fits: impl Fn(&Inside<'_>) -> bool) {
        let Some(at) = self.frames.iter().rposition(|frame| fits(&frame.inside)).filter(|&at| at > 0) else { return };
        let closed = self.frames.drain(at..).next();
        let Some(frame) = self.frames.last_mut() else { return };
        match closed {
            Some(Frame { inside: Inside::Parameters, names, .. }) => {
                frame.pending = names;
                frame.expects = Expects::AfterName;
            }
            Some(Frame { inside: Inside::Statements { .. } | Inside::Properties(_), .. }) => {
                frame.end_of_statement();
            }
            _ => {
                frame.last = None;
                frame.expects = Expects::After;
            }
        }
    }

    fn sign(&mut self, sign: &str) {
        let Some(frame) = self.frames.last_mut() else { return };
        match sign {
            ":" => match frame.expects {
                Expects::AfterName => frame.expects = Expects::Type,
                Expects::Colon | Expects::After => self.labelled(),
                _ => {}
            },
            "," => match frame.inside {
                Inside::Call { .. } => {
                    frame.next_argument();
                    self.argument();
                }
                Inside::Properties(_) | Inside::Record => frame.expects = Expects::Label,
                Inside::Parameters => frame.expects = Expects::Name,
                Inside::Group => {
                    let slot = frame.slot;
                    frame.again(slot);
                }
                Inside::Arms => frame.expects = Expects::After,
                Inside::Statements { .. } | Inside::Text | Inside::Interpolation => {}
            },
            "=" => frame.assigned(),
            "=>" => {
                let slot = frame.slot;
                frame.again(slot);
            }
            "." => {
                if let Some(Called { module: None, name }) = frame.last.take() {
                    frame.expects = Expects::Member(name);
                }
            }
            ".." => {
                let slot = frame.slot;
                frame.again(slot);
            }
            "-" if frame.expects != Expects::After => {}
            _ if frame.expects == Expects::After => frame.again(operand(frame.slot)),
            _ => {}
        }
    }

    /// Behind `label:`.
    fn labelled(&mut self) {
        let Some(frame) = self.frames.last_mut() else { return };
        match frame.inside {
            Inside::Properties(block) => {
                let label = frame.label;
                let known = reference::properties(block).iter().find(|known| Some(known.name) == label);
                frame.value(known.map_or(Slot::ANY, |known| known.slot), label);
            }
            Inside::Record => frame.value(Slot::ANY, frame.label),
            Inside::Call { .. } => {
                // What was read as a value is the argument's name.
                if let Some(Called { module: None, name }) = frame.last.take() {
                    frame.label = Some(name);
                }
                if let Some(label) = frame.label {
                    frame.labels.push(label);
                }
                self.argument();
                if let Some(frame) = self.frames.last_mut() {
                    frame.expects = Expects::Operand;
                }
            }
            Inside::Statements { .. }
            | Inside::Parameters
            | Inside::Group
            | Inside::Arms
            | Inside::Text
            | Inside::Interpolation => {}
        }
    }

    /// Finds what the argument at hand of the innermost call takes.
    fn argument(&mut self) {
        let depth = self.frames.len();
        let around = depth.checked_sub(2).and_then(|at| self.frames.get(at)).map_or(Slot::ANY, |frame| frame.here);
        let Some(frame) = self.frames.last_mut() else { return };
        let Inside::Call { called, slot } = frame.inside else { return };
        let mut labels = frame.labels.clone();
        labels.extend(frame.label);
        let argument = frame.argument();
        let user = self.known.parameters(&called, slot);
        let (takes, owner) = match (&user, argument) {
            (Some(list), Argument::Named(label)) => {
                (list.iter().find(|(name, _)| name == label).map(|(_, s)| *s), None)
            }
            (Some(list), Argument::Place(place)) => (list.get(place).map(|(_, slot)| *slot), None),
            (None, argument) => {
                let signature = match called.module {
                    None => reference::callable(called.name, slot, &labels),
                    Some(_) => None,
                };
                let params = signature.map_or(&[][..], |signature| signature.params());
                let param = match argument {
                    Argument::Named(label) => params.iter().find(|param| param.name() == label),
                    Argument::Place(place) => params.get(place),
                };
                (param.map(|param| param.slot()), param.map(|param| param.name()))
            }
        };
        let takes = match takes {
            Some(takes) if takes.kind.is_some() => takes,
            // Where anything is taken, the names of the call's own place are known.
            _ => operand(around),
        };
        frame.slot = takes;
        frame.here = takes;
        frame.owner = owner.or(frame.label);
    }

    /// What may stand where the walk ends.
    fn place(&self, in_text: bool, leads: bool, is_label: bool) -> (Place<'t>, Slot) {
        let Some(frame) = self.frames.last() else { return (Place::Nothing, Slot::ANY) };
        let slot = frame.here;
        if in_text {
            return (Place::Text { owner: frame.owner }, slot);
        }
        let place = match frame.expects {
            Expects::Statement => {
                let Inside::Statements { is_top } = frame.inside else { return (Place::Nothing, slot) };
                Place::Statement { is_top, head: frame.head }
            }
            Expects::Label => match frame.inside {
                Inside::Properties(block) => Place::Property(block),
                Inside::Call { .. } => Place::Argument,
                _ => Place::Nothing,
            },
            Expects::Name | Expects::Colon => Place::Nothing,
            Expects::AfterName => Place::Operator { head: frame.head },
            Expects::Type => Place::Type,
            Expects::Member(module) => Place::Member(module),
            Expects::Operand => match frame.inside {
                Inside::Call { .. } if is_label => Place::Argument,
                _ => Place::Value { owner: frame.owner },
            },
            Expects::After => match frame.inside {
                Inside::Statements { is_top } if leads => Place::Statement { is_top, head: frame.head },
                Inside::Properties(block) => Place::Property(block),
                Inside::Call { .. } if is_label => Place::Argument,
                _ => Place::Operator { head: frame.head },
            },
        };
        (place, slot)
    }

    fn calls(&self) -> Vec<CallAt<'t>> {
        let calls = self.frames.iter().filter_map(|frame| match frame.inside {
            Inside::Call { called, slot } => {
                let mut labels = frame.labels.clone();
                // The argument at hand is not given yet.
                labels.retain(|label| Some(*label) != frame.label);
                Some(CallAt { called, slot, labels, argument: frame.argument() })
            }
            _ => None,
        });
        calls.collect()
    }

    fn locals(&self, begin: usize) -> Vec<(&'t str, usize)> {
        let names = self.frames.iter().enumerate().flat_map(|(depth, frame)| {
            // What the top level declares is found in the whole file.
            let names: &[_] = if depth == 0 { &[] } else { &frame.names };
            names.iter().chain(&frame.pending)
        });
        names.filter(|(name, _)| !RESERVED.contains(name)).map(|&(name, at)| (name, begin + at)).collect()
    }
}

/// Operands know the names of their place only where operators keep its kind.
fn operand(slot: Slot) -> Slot {
    match slot.kind {
        Some(Kind::Region | Kind::Field) => Slot { words: &[], ..slot },
        _ => Slot::ANY,
    }
}
