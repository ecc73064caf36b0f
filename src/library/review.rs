//! What a test of a library found, for people to judge and for other programs to read.
//!
//! A [`Review`] is written as one HTML page ([`super::page`]), as Markdown with pictures beside it ([`super::markdown`]) and as
//! JUnit ([`super::junit`]).

use std::fmt;

use super::pin;

/// All that a test found.
#[derive(Debug, Clone, Default)]
pub struct Review {
    /// What was tested: the library's name and version.
    pub title: String,
    /// Every swatch, in order.
    pub swatches: Vec<Swatch>,
    /// What is wrong besides: dependencies that are not what was locked.
    pub faults: Vec<String>,
}

/// One swatch.
#[derive(Debug, Clone)]
pub struct Swatch {
    /// Its name: the path of its file in `swatches/`, without the ending.
    pub name: String,
    /// The path of its file from the library's root; of the pin for one whose swatch is gone.
    pub file: String,
    /// How it compares with its pin.
    pub outcome: Outcome,
    /// Every value that is not what was pinned.
    pub changes: Vec<pin::Change>,
    /// Its pictures, as PNG.
    pub pictures: Pictures,
    /// What was said of it: diagnostics as text.
    pub said: String,
}

/// How a swatch compares with its pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// It is what was pinned.
    Same,
    /// It is something else than what was pinned.
    Changed(Reason),
    /// It has no pin yet.
    New,
    /// It does not compile.
    Broken,
    /// There is a pin, but no swatch of its name.
    Orphan,
}

/// What differs of a swatch that changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// The drawing, and so many of the picture's pixels.
    Seen {
        /// How many pixels differ visibly.
        pixels: u64,
        /// Of how many.
        of: u64,
    },
    /// The drawing and some figures, but no pixel of the picture.
    Measured,
    /// The drawing alone.
    Hidden,
    /// The figures or warnings alone: the drawing is the same.
    Figures,
    /// The drawing; what it looked like is not known, for the pinned picture is missing or damaged.
    Unseen,
    /// The drawing is the same, but the pinned picture is missing or damaged.
    PictureLost,
    /// The pin cannot be read.
    PinLost,
}

impl Outcome {
    /// In one word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Same => "same",
            Self::Changed(_) => "changed",
            Self::New => "new",
            Self::Broken => "broken",
            Self::Orphan => "orphan",
        }
    }
}

impl Outcome {
    /// As a sentence of its own.
    #[must_use]
    pub fn sentence(self) -> String {
        let words = self.to_string();
        let mut letters = words.chars();
        letters.next().map_or_else(String::new, |first| format!("{}{}.", first.to_uppercase(), letters.as_str()))
    }

    /// Whether accepting pins it, or removes its pin.
    #[must_use]
    pub fn is_acceptable(self) -> bool {
        match self {
            Self::Changed(_) | Self::New | Self::Orphan => true,
            Self::Same | Self::Broken => false,
        }
    }
}

/// In words that go on after a colon; nothing for what is the same.
impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Same => Ok(()),
            Self::Changed(reason) => reason.fmt(f),
            Self::New => f.write_str("it has no pin yet"),
            Self::Broken => f.write_str("it does not compile"),
            Self::Orphan => f.write_str("there is a pin, but no swatch of this name"),
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Seen { pixels, of } => {
                let (shown, all) = (crate::diag::grouped(*pixels), crate::diag::grouped(*of));
                let (verb, share) = (if *pixels == 1 { "differs" } else { "differ" }, *pixels as f64 / *of as f64);
                write!(f, "{shown} of {all} pixels {verb} ({:.1} %)", share * 100.0)
            }
            Self::Measured => {
                f.write_str("the drawing and its figures changed, but no pixel of the small picture shows it")
            }
            Self::Hidden => {
                f.write_str("the drawing changed by so little that neither the small picture nor any figure shows it")
            }
            Self::Figures => f.write_str("the drawing is the same; its figures or warnings changed"),
            Self::Unseen => f.write_str("the drawing changed; the pinned picture is missing or damaged"),
            Self::PictureLost => f.write_str("the drawing is the same, but the pinned picture is missing or damaged"),
            Self::PinLost => f.write_str("the pin cannot be read"),
        }
    }
}

/// Pictures of a swatch as PNG.
#[derive(Debug, Clone, Default)]
pub struct Pictures {
    /// What was pinned.
    pub old: Option<Vec<u8>>,
    /// What it is now.
    pub new: Option<Vec<u8>>,
    /// What went and what came.
    pub difference: Option<Vec<u8>>,
}

impl Pictures {
    /// Those that there are, each with what it is called.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, &[u8])> {
        let all = [("old", &self.old), ("new", &self.new), ("difference", &self.difference)];
        all.into_iter().filter_map(|(name, picture)| Some((name, picture.as_deref()?)))
    }
}

impl Review {
    /// Whether all swatches are what was pinned, and nothing else is wrong.
    #[must_use]
    pub fn is_same(&self) -> bool {
        self.faults.is_empty() && self.swatches.iter().all(|swatch| swatch.outcome == Outcome::Same)
    }

    /// Whether there is something that accepting changes.
    #[must_use]
    pub fn is_acceptable(&self) -> bool {
        self.swatches.iter().any(|swatch| swatch.outcome.is_acceptable())
    }

    /// What is not as it was pinned: what is broken first, then what changed, what is new and what is gone.
    #[must_use]
    pub fn to_review(&self) -> Vec<&Swatch> {
        let rank = |swatch: &&Swatch| match swatch.outcome {
            Outcome::Broken => 0,
            Outcome::Changed(_) => 1,
            Outcome::New => 2,
            Outcome::Orphan => 3,
            Outcome::Same => 4,
        };
        let mut found: Vec<&Swatch> = self.swatches.iter().filter(|swatch| swatch.outcome != Outcome::Same).collect();
        found.sort_by_key(rank);
        found
    }

    /// How many swatches there are of each outcome: `5 swatches: 3 same, 1 changed, 1 broken`.
    #[must_use]
    pub fn summary(&self) -> String {
        let words = ["same", "changed", "new", "broken", "orphan"];
        let counted = words.into_iter().filter_map(|word| {
            let count = self.swatches.iter().filter(|swatch| swatch.outcome.word() == word).count();
            (count > 0).then(|| format!("{count} {word}"))
        });
        let counted: Vec<String> = counted.collect();
        let n = self.swatches.iter().filter(|swatch| swatch.outcome != Outcome::Orphan).count();
        let swatches = if n == 1 { "1 swatch".to_owned() } else { format!("{n} swatches") };
        if counted.is_empty() { swatches } else { format!("{swatches}: {}", counted.join(", ")) }
    }
}

/// The name of a file of a report that shows a swatch.
#[must_use]
pub fn picture_file(swatch: &str, kind: &str) -> String {
    format!("pictures/{}-{kind}.png", swatch.replace('/', "-"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::{junit, markdown, page};

    fn swatch(name: &str, outcome: Outcome) -> Swatch {
        let change = pin::Change { what: "a|b: c_cov".to_owned(), old: None, new: Some("0.5".to_owned()) };
        Swatch {
            name: name.to_owned(),
            file: format!("swatches/{name}.kake"),
            outcome,
            changes: vec![change],
            pictures: Pictures { old: None, new: Some(b"picture".to_vec()), difference: None },
            said: "```\n<script>alert(1)</script>\u{1b}[31m\n".to_owned(),
        }
    }

    fn review() -> Review {
        let seen = Outcome::Changed(Reason::Seen { pixels: 1, of: 4096 });
        Review {
            title: "ink <b> 0.1.0".to_owned(),
            swatches: vec![
                swatch("a", Outcome::Same),
                swatch("b*_<i>", seen),
                swatch("c", Outcome::Orphan),
                swatch("d/e", Outcome::Broken),
            ],
            faults: vec!["the dependency `x` is not locked".to_owned()],
        }
    }

    #[test]
    fn what_is_broken_comes_first() {
        let names: Vec<String> = review().to_review().iter().map(|swatch| swatch.name.clone()).collect();
        assert_eq!(names, ["d/e", "b*_<i>", "c"]);
        assert_eq!(review().summary(), "3 swatches: 1 same, 1 changed, 1 broken, 1 orphan");
        assert_eq!(review().swatches[1].outcome.sentence(), "1 of 4,096 pixels differs (0.0 %).");
        assert!(!review().is_same() && review().is_acceptable());
    }

    #[test]
    fn markdown_takes_names_as_they_are() {
        let text = markdown::write(&[review()]);
        for line in [
            "# ink \\<b\\> 0.1.0",
            "- **fault**: the dependency \\`x\\` is not locked",
            "## b\\*\\_\\<i\\>: changed",
            "| ![new](<pictures/d-e-new.png>) |",
            "| a\\|b: c\\_cov | – | 0.5 |",
            "````text",
            "`kake test --accept` pins what is there now.",
        ] {
            assert!(text.lines().any(|found| found == line), "{line}\n{text}");
        }
    }

    #[test]
    fn pages_take_names_as_they_are_and_need_nothing_else() {
        let page = page::write(&[review()]);
        for hostile in ["<script", "<b>", "<i>", "http:", "https:", "<link"] {
            assert!(!page.contains(hostile), "{hostile}");
        }
        assert!(page.contains("&lt;script&gt;") && page.contains("data:image/png;base64,cGljdHVyZQ=="));
    }

    #[test]
    fn build_servers_are_told() {
        let xml = junit::write(&[review()]).expect("it can be written");
        let document = usvg::roxmltree::Document::parse(&xml).expect("it is XML");
        let attribute = |name| document.root_element().attribute(name);
        assert_eq!([attribute("tests"), attribute("failures"), attribute("errors")], [Some("5"), Some("3"), Some("1")]);
        let messages: Vec<_> = document.descendants().filter_map(|node| node.attribute("message")).collect();
        assert_eq!(
            messages,
            [
                "swatches/b*_<i>.kake: 1 of 4,096 pixels differs (0.0 %)",
                "swatches/c.kake: there is a pin, but no swatch of this name",
                "swatches/d/e.kake: it does not compile",
                "the dependency `x` is not locked",
            ]
        );
    }
}
