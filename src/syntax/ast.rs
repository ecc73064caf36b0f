//! The syntax tree that both front ends make: what was written, with its place, and nothing decided.
//!
//! Names are unresolved, units are kept as written and no value has been computed. Chains of operators of one
//! precedence are flat lists, so that the depth of a tree is the depth of its brackets.

use crate::span::{SourceId, Span};

/// A parsed file.
#[derive(Debug, Clone)]
pub struct Document {
    /// The text it was read from.
    pub source: SourceId,
    /// The statements in the order they stand.
    pub statements: Vec<Statement>,
    /// Comments that document nothing, in the order they stand. Only the `.kake` front end has any.
    pub comments: Vec<Comment>,
}

/// A comment other than a doc comment that is attached to a declaration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Comment {
    /// With its `//` or `/* */`.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// An identifier, in Unicode normal form C.
#[derive(Debug, Clone)]
pub struct Ident {
    /// The name.
    pub name: String,
    /// Where it stands.
    pub span: Span,
}

/// A doc comment: the lines without their `///` and one space after it, joined by line ends.
#[derive(Debug, Clone)]
pub struct Doc {
    /// The text.
    pub text: String,
    /// From the first `///` to the end of the last line.
    pub span: Span,
}

/// One statement.
#[derive(Debug, Clone)]
pub struct Statement {
    /// The doc comment above it.
    pub doc: Option<Doc>,
    /// What it says.
    pub kind: StatementKind,
    /// From its first word to its last, without the doc comment.
    pub span: Span,
}

/// The kinds of statement.
#[derive(Debug, Clone)]
pub enum StatementKind {
    /// `edition 1`
    Edition(Expr),
    /// `import "file" as name`
    Import {
        /// The path as written, a plain string.
        path: Text,
        /// The module's name.
        alias: Option<Ident>,
    },
    /// `canvas { … }`
    Canvas(Vec<Property>),
    /// `seed 42`
    Seed(Expr),
    /// `let name: type = value`
    Let(Binding),
    /// `param name: type = default in domain`
    Param {
        /// Name, type and default.
        binding: Binding,
        /// A range or a list of choices.
        domain: Option<Expr>,
    },
    /// `field name = value`
    Field(Binding),
    /// `region name = value`
    Region(Binding),
    /// `tone name(parameters) …`
    Tone {
        /// The tone's name.
        name: Ident,
        /// Its parameters.
        params: Vec<Parameter>,
        /// Its properties, or what it derives from.
        body: ToneBody,
    },
    /// `fn name(parameters) = value`
    Fn {
        /// The function's name.
        name: Ident,
        /// Its parameters.
        params: Vec<Parameter>,
        /// Its value.
        body: Expr,
    },
    /// `paint REGION with TONE(args) as "name" seed N`
    Paint {
        /// What is painted.
        region: Expr,
        /// A name, a module's member or a call of either.
        tone: Expr,
        /// The paint's name.
        name: Option<Expr>,
        /// Its own seed.
        seed: Option<Expr>,
    },
    /// `outline REGION pen LENGTH`
    Outline {
        /// Whose outline.
        region: Expr,
        /// The stroke's width.
        pen: Option<Expr>,
    },
    /// `ink DRAWING`
    Ink {
        /// The drawing, a call of `svg`.
        drawing: Expr,
    },
    /// `layer "name" ink COLOUR { … }`
    Layer {
        /// The layer's name.
        name: Expr,
        /// Its ink.
        ink: Option<Expr>,
        /// What it holds.
        body: Vec<Statement>,
    },
    /// `for x in LIST { … }`
    For {
        /// The loop's variable.
        variable: Ident,
        /// A range or a list.
        iterable: Expr,
        /// What is repeated.
        body: Vec<Statement>,
    },
    /// `if … { … } else if … { … } else { … }`
    If {
        /// Conditions with what they guard, in order; never empty.
        branches: Vec<(Expr, Vec<Statement>)>,
        /// The last `else`.
        otherwise: Option<Vec<Statement>>,
    },
    /// `experiment name { … }`
    Experiment {
        /// The experiment's name.
        name: Ident,
        /// Its properties.
        properties: Vec<Property>,
    },
}

/// A plain string without interpolation.
#[derive(Debug, Clone)]
pub struct Text {
    /// The string's value.
    pub value: String,
    /// Where it stands, with its quotes.
    pub span: Span,
}

/// `name: type = value`, as in `let`, `param`, `field` and `region`.
#[derive(Debug, Clone)]
pub struct Binding {
    /// The name.
    pub name: Ident,
    /// The type that was pinned.
    pub ty: Option<Ident>,
    /// The value.
    pub value: Expr,
}

/// A parameter of a tone or function.
#[derive(Debug, Clone)]
pub struct Parameter {
    /// The doc comment above it.
    pub doc: Option<Doc>,
    /// Its name.
    pub name: Ident,
    /// Its type.
    pub ty: Option<Ident>,
    /// The value it has where none is given.
    pub default: Option<Expr>,
}

/// The right-hand side of a tone.
#[derive(Debug, Clone)]
pub enum ToneBody {
    /// `{ property: value … }`
    Properties(Vec<Property>),
    /// `= base(args) with { property: value … }`
    Derived {
        /// A name, a module's member or a call of either.
        base: Expr,
        /// What differs.
        with: Vec<Property>,
    },
}

/// `name: value`
#[derive(Debug, Clone)]
pub struct Property {
    /// The doc comment above it.
    pub doc: Option<Doc>,
    /// The property's name.
    pub name: Ident,
    /// Its value.
    pub value: Expr,
}

impl Property {
    /// From the name to the end of the value.
    #[must_use]
    pub fn span(&self) -> Span {
        self.name.span.to(self.value.span)
    }
}

/// An expression.
#[derive(Debug, Clone)]
pub struct Expr {
    /// What it says.
    pub kind: ExprKind,
    /// Where it stands.
    pub span: Span,
}

/// The kinds of expression.
#[derive(Debug, Clone)]
pub enum ExprKind {
    /// `12`, `6mm`, `50%`
    Number {
        /// The number before the unit.
        value: f64,
        /// The number as written, without its unit.
        text: String,
        /// `mm`, `deg`, `%`…: known units only.
        unit: Option<Unit>,
    },
    /// `#rrggbb`, as written with its `#`; the digits are known to be three, four, six or eight hexadecimal ones.
    Colour(String),
    /// `"text {expr}"`
    String(Vec<StringPart>),
    /// `true`, `false`
    Bool(bool),
    /// A bare name.
    Name(String),
    /// `module.name`
    Member(Box<Expr>, Ident),
    /// `name(args)`
    Call(Box<Expr>, Vec<Argument>),
    /// `list[index]`
    Index(Box<Expr>, Box<Expr>),
    /// `(a)`
    Group(Box<Expr>),
    /// `(x, y)`, `(x, y, width, height)`: two or more members
    Tuple(Vec<Expr>),
    /// `[a, b]`
    List(Vec<Expr>),
    /// `a .. b`
    Range(Box<Expr>, Box<Expr>),
    /// `{ name: value }`
    Record(Vec<Property>),
    /// Prefix operators, outermost first.
    Unary(Vec<UnaryOp>, Box<Expr>),
    /// Operators of one precedence, to be read from the left (powers from the right).
    Binary(Box<Expr>, Vec<(BinaryOp, Expr)>),
    /// `if a then b else if c then d else e`
    If {
        /// Conditions with their values; never empty.
        branches: Vec<(Expr, Expr)>,
        /// The value where none holds.
        otherwise: Box<Expr>,
    },
    /// `match v { pattern => value … }`
    Match {
        /// What is matched.
        subject: Box<Expr>,
        /// The arms in order.
        arms: Vec<Arm>,
    },
    /// What could not be read: already reported, and silent from here on.
    Error,
}

/// A piece of a string.
#[derive(Debug, Clone)]
pub enum StringPart {
    /// Plain text, with its escapes resolved.
    Text(String),
    /// `{expr}`
    Expr(Expr),
}

/// An argument of a call.
#[derive(Debug, Clone)]
pub struct Argument {
    /// The name before the colon.
    pub name: Option<Ident>,
    /// The value.
    pub value: Expr,
}

/// An arm of a `match`.
#[derive(Debug, Clone)]
pub struct Arm {
    /// What it matches.
    pub pattern: Pattern,
    /// Where the pattern stands.
    pub span: Span,
    /// The value.
    pub value: Expr,
}

/// What an arm matches.
#[derive(Debug, Clone, PartialEq)]
pub enum Pattern {
    /// A string.
    String(String),
    /// A number, as its value and its text.
    Number(f64, String),
    /// `true` or `false`.
    Bool(bool),
    /// `_`
    Any,
}

/// Prefix operators.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnaryOp {
    /// `-`
    Minus,
    /// `not`
    Not,
}

/// Infix operators.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BinaryOp {
    /// `or`
    Or,
    /// `and`
    And,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `%`
    Remainder,
    /// `&`
    Intersect,
    /// `^`
    Power,
}

impl BinaryOp {
    /// As it is written.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Or => "or",
            Self::And => "and",
            Self::Equal => "==",
            Self::NotEqual => "!=",
            Self::Less => "<",
            Self::LessEqual => "<=",
            Self::Greater => ">",
            Self::GreaterEqual => ">=",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Remainder => "%",
            Self::Intersect => "&",
            Self::Power => "^",
        }
    }

    /// How strongly it binds; a greater number binds tighter. Comparisons do not chain. A range `a .. b` binds at 0
    /// and the prefix `-` between `*` and `^`; `not` takes the comparison behind it.
    #[must_use]
    pub fn precedence(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::And => 2,
            Self::Equal | Self::NotEqual | Self::Less | Self::LessEqual | Self::Greater | Self::GreaterEqual => 3,
            Self::Add | Self::Subtract => 4,
            Self::Multiply | Self::Divide | Self::Remainder | Self::Intersect => 5,
            Self::Power => 7,
        }
    }
}

/// The units a number may carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Millimetres.
    Millimetre,
    /// Centimetres.
    Centimetre,
    /// Inches.
    Inch,
    /// Points, 1/72 inch.
    Point,
    /// Pixels, 1/dpi inch.
    Pixel,
    /// Degrees.
    Degree,
    /// Radians.
    Radian,
    /// Whole turns.
    Turn,
    /// Per cent.
    Percent,
}

impl Unit {
    /// Every unit.
    pub const ALL: [Self; 9] = [
        Self::Millimetre,
        Self::Centimetre,
        Self::Inch,
        Self::Point,
        Self::Pixel,
        Self::Degree,
        Self::Radian,
        Self::Turn,
        Self::Percent,
    ];

    /// As it is written behind a number.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Inch => "in",
            Self::Point => "pt",
            Self::Pixel => "px",
            Self::Degree => "deg",
            Self::Radian => "rad",
            Self::Turn => "turn",
            Self::Percent => "%",
        }
    }
}
