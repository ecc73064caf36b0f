//! The table of diagnostic codes: their names, titles and explanations, the text of `kake explain`.

/// Declares the enum and its table in one place, so that neither can lack a code.
macro_rules! codes {
    ($($variant:ident $name:literal $title:literal $explanation:literal)*) => {
        /// The kinds of mistake. Their names are stable: scripts may rely on them.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $(#[doc = $title] $variant,)*
        }

        impl Code {
            /// Every code, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// The stable name without its `kake::`.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// What the code is about, in a few words.
            #[must_use]
            pub fn title(self) -> &'static str {
                match self { $(Self::$variant => $title,)* }
            }

            /// What `kake explain` prints below the title.
            #[must_use]
            pub fn explanation(self) -> &'static str {
                match self { $(Self::$variant => $explanation,)* }
            }
        }
    };
}

impl Code {
    /// Finds a code by its name, with or without `kake::`.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let name = name.strip_prefix("kake::").unwrap_or(name);
        Self::ALL.iter().copied().find(|code| code.name() == name)
    }
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "kake::{}", self.name())
    }
}

codes! {
    Syntax "syntax" "The text does not follow the grammar"
        "The file is read statement by statement. Where one cannot be read, the message names what was expected there, \
         and reading goes on at the next statement, so that one slip does not hide the others.\n\n\
         The grammar is short: `docs/language.md` has all of it."
    Toml "toml" "The TOML does not have the form of a scene"
        "A scene in TOML has the tables `canvas`, `param`, `let`, `field`, `region`, `tone`, `fn` and `experiment`, the \
         values `edition` and `seed`, and the arrays `import` and `draw`. Strings other than names, paths and docs hold \
         expressions of the language: `size = \"(60mm, 60mm)\"`, `default = '\"poisson\"'`."
    Nesting "nesting" "Brackets, conditions or blocks are nested too deeply"
        "Nesting is limited so that no text can exhaust the stack. Give the inner parts names with `let`."
    Encoding "encoding" "The file is not UTF-8"
        "Scenes are UTF-8 text. Save the file in that encoding; the message names the first byte that does not fit."
    Empty "empty" "There is nothing to paint"
        "The scene has no `paint` or `outline` statement that is carried out. A library of tones is not built by itself: \
         import it from a scene and paint a region with one of its tones."
    Edition "edition" "The edition is not known"
        "This program knows edition 1 of the language."
    Order "order" "A statement stands in the wrong place"
        "`edition`, `canvas` and `seed` stand once each, at the top level and before the first thing that draws; \
         `import`, `param`, `tone`, `fn` and `experiment` stand at the top level."
    UnknownName "unknown-name" "A name is not known here"
        "A bare name is looked up among the names that are declared around it, then among the words that fit the place \
         where it stands. Names of an import with `as` are written `module.name`."
    UnknownFunction "unknown-function" "A function, shape, fill or other call is not known"
        "What is called is neither declared with `fn` nor part of the language. `docs/language.md` lists every \
         placement, shape, angle rule, fill, field and region."
    UnknownTone "unknown-tone" "A tone is not known"
        "Tones have a name space of their own. Those of an import with `as` are written `module.tone`."
    UnknownProperty "unknown-property" "A property is not known"
        "Each block knows a fixed set of properties; the message lists near ones."
    UnknownArgument "unknown-argument" "A call has no argument of this name"
        "Arguments are given by position or by name. The message names the ones that the call knows."
    UnknownUnit "unknown-unit" "A unit is not known"
        "Lengths take `mm cm in pt px`, angles `deg rad turn`, shares `%`. A unit touches its number."
    UnknownType "unknown-type" "A type is not known"
        "Types are `number length angle percentage colour string point box list range record bool` and the scene's own \
         `region field placement shape angles fill hand tone`."
    Alike "alike" "Neighbours have the same direction"
        "`coloured` found no way to give every two neighbours different directions with so few, and left some alike. Four \
         are enough for every page that does not repeat; one that repeats may need up to seven."
    Duplicate "duplicate" "A name is given twice"
        "Declarations, properties, arguments and the names of paints are each given once. Two imports may bring the same \
         declaration, but not two different ones under one name."
    Conflict "conflict" "Two properties do not go together"
        "A tone has one or the other. What a derived tone inherits counts as well: derive it from one that leaves the \
         other out."
    Missing "missing" "Something required is not given"
        "The call, block or declaration cannot do without the thing that the message names."
    TooMany "too-many-arguments" "A call has more arguments than it takes"
        "The message names the arguments that the call knows."
    Type "type" "A value is of the wrong kind"
        "Every place takes one kind of value. Kinds are not mixed silently: a length is no number and a string is no \
         choice unless it names one. A bare number is a length in canvas units where a length is asked for."
    Unit "unit" "Units do not go together"
        "Lengths add to lengths and angles to angles; the product of two lengths is no value of the language. A quotient \
         of two lengths is a number."
    Range "out-of-range" "A value is outside what is allowed"
        "The message names the bounds. Radii, pitches and pens are greater than zero, and no value is infinite or \
         undefined."
    Choice "choice" "The value is not among the choices"
        "A parameter declared with `in [...]` takes one of the listed values."
    Match "match" "A match does not cover its value"
        "A `match` needs an arm for every value: the arms list each choice, or the last one is `_`."
    Cycle "cycle" "A declaration needs itself"
        "A declaration, import or derived tone leads back to itself. The notes show the way round."
    Recursion "recursion" "Functions call each other too deeply"
        "A function that calls itself needs a condition that ends it within the limit of nesting."
    Limit "limit" "A limit was reached"
        "Scenes come from strangers, so loops, tiles, strokes and pictures have limits. `--limit name=value` lifts one."
    Import "import" "A file cannot be imported"
        "Imports are scenes in `.kake` or `.toml`, found from the folder of the file that names them."
    Manifest "manifest" "The manifest of a library is at fault"
        "`kake.toml` stands in the root folder of a library. It may be empty; then it only marks the root. `[library]` has \
         a `name`, a `version` and an `edition`; `[dependencies]` names other libraries by the paths of their folders: \
         `ink = { path = \"../ink\" }`. `docs/libraries.md` says more."
    Dependency "dependency" "A library has no such dependency"
        "A path such as `\"ink:tones/wash.kake\"` names a file of the library that `kake.toml` calls `ink` under \
         `[dependencies]`. Every library sees its own dependencies only."
    Lock "lock" "A dependency is not what was locked"
        "`kake.lock` holds what the dependencies' files were when `kake lock` was last run. Other files make other pictures. \
         Where the change is wanted, run `kake lock`; otherwise bring the dependency back to what it was."
    Pin "pin" "A pin cannot be read"
        "`pins/NAME.toml` holds what a swatch looked like when it was last accepted. It is written by `kake test --accept`, \
         which also replaces one that was damaged."
    File "file" "A file cannot be read"
        "Paths are found from the folder of the file that names them."
    Outside "outside-root" "A path leads out of the scene's root"
        "A scene reads only files below its root: the nearest folder upwards that holds a `kake.toml`, otherwise the \
         scene's own folder. `--root DIR` names another."
    Image "image" "The file is not a picture that can be read"
        "Pictures are PNG or JPEG."
    Svg "svg" "The file is not an SVG that can be read"
        "Regions are taken from the filled shapes of an SVG file, floods from its lines, and ink from both."
    SvgId "svg-id" "The SVG file has no such element"
        "The name is looked up among the ids, layers, classes or colours of the file's elements. Only elements that fill an \
         area can be regions."
    SvgLook "svg-look" "Part of an SVG file is not drawn as the file has it"
        "`ink` draws strokes and fills in plain colours. Gradients are drawn in their mean colour; patterns, pictures and \
         text are left out; masks, filters and blending are ignored. Joins are round."
    Flood "flood" "A flood starts where it cannot"
        "A flood starts at a point of the canvas that lies on the drawing's page, and in the white between its lines: not \
         on a stroke or a dark fill."
    Leak "leak" "A flood leaks"
        "The flood reaches the border of the drawing's page. Gaps between lines are bridged up to `close`, 0.5 mm by \
         default; the message names the widest of the gaps that would have to be bridged. Where the border itself is meant \
         to hold the flood, as it holds a sky, write `border: wall`."
    Path "path-data" "The path data cannot be read"
        "Path data is what stands in the `d` attribute of an SVG path: `M 0 0 L 10 0 L 10 10 Z`. Units are canvas units."
    EmptyRegion "empty-region" "A region holds nothing"
        "What is left of the region has no area, so that nothing could be painted."
    Offside "off-canvas" "A region lies outside the canvas"
        "No part of the region lies on the canvas, so that nothing of it would be seen."
    Param "param" "A parameter cannot be set"
        "`--set name=value` sets a parameter that the scene declares with `param`, within its type, range or choices."
    Unnamed "unnamed-paint" "A paint has only a numbered name"
        "Paints without `as` are called after their tone. A second one of the same tone is numbered, and its number, with \
         all its random draws, shifts when a paint is added before it. Name it with `as \"name\"`."
    Clamped "clamped" "Values were brought into their range"
        "A field gives values outside what the property takes; they were clamped. `clamp(f, low, high)` says so in the \
         scene and silences the warning."
    TooDark "too-dark" "A darkness is more than the tone prints"
        "However many layers there are, lines leave some paper bare between them. What asks for more is printed as dark \
         as the tone goes. A tighter pitch, a wider pen or more fills print darker, `solid: 0.9` inks the darkest tiles \
         all over, and `range: fit` presses the whole picture into the tone's range."
    Checkerboard "checkerboard" "A checkerboard needs a grid"
        "`checkerboard()` alternates along rows and columns, which only `grid(...)` has."
    Repeat "repeat" "This does not go with a canvas that repeats"
        "On a canvas with `repeat: true` the left border continues on the right and the upper one below. Tiles must not meet \
         their own copies, so each side is at least two tiles long, and a pattern has to come out even after one period."
    Stretched "stretched" "A lattice was stretched to fit a canvas that repeats"
        "Between the borders of a canvas that repeats lies a whole number of cells, and an even number of rows of a \
         hexagonal lattice. The message names the size that was asked for and the one that fits."
    Seam "seam" "A field does not repeat"
        "On a canvas that repeats a field should have the same values at opposite borders, as noise has, or tone jumps where \
         copies meet. Strokes continue all the same."
    Hand "hand" "A hand strays too far"
        "Strokes that wander by more than half of the pitch run into each other, and strokes that overshoot by more than the \
         distance of tiles cross their neighbours. The picture is drawn as the scene says."
    Tiling "tiling" "Cells need a placement that is a tiling"
        "`cell(...)` draws the cells of a tiling and `link: edges` joins those that share an edge. `grid`, `hex`, \
         `triangles`, `penrose` and `pinwheel` are tilings. Sites of other placements get cells with `voronoi(...)`."
    NoTiles "no-tiles" "A paint draws nothing"
        "The placement put no tile on the region, which may be smaller than the distance between sites; or there are \
         tiles, but nothing of their fill is left: strokes are shorter than `shortest`, dots do not fit, or later tiles \
         hide them."
    Metadata "metadata" "The picture holds no scene"
        "A picture can be built again when it was written by this program with `--embed text` (the default) or \
         `--embed all`."
}
