//! Bundles: a scene with all that it reads in one text.
//!
//! In: the scene's text and the files that it imports and reads. Out: one text that begins with the scene, as it stands, and
//! goes on with the files in comments; and back again. A reader that knows no bundles sees the scene and some comments, so
//! that nothing in it moves to another line. Texts stay legible, all else is base64.
//!
//! Bundles come from strangers. Paths that lead anywhere but into a folder of the bundle's own, paths that occur twice, and
//! more than is bearable are refused in words.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;

use crate::loader;

/// How the line behind the scene goes on after its comment sign; the scene's path follows as a JSON string.
const HEAD: &str = " kake bundle 1 ";
/// The last line, after the comment sign: a text without it was cut short on its way.
const END: &str = " end of the bundle";
/// How it begins, whatever the version.
const ANY_HEAD: &str = " kake bundle ";

/// The most bytes that all files of a bundle have together.
pub const LARGEST: usize = 256 << 20;
/// The most files of a bundle.
pub const MOST: usize = 10_000;
/// The longest path.
const LONGEST_PATH: usize = 1024;

/// The longest name of a file or folder, in bytes.
const LONGEST_PART: usize = 255;
/// Files that say what a library is: a bundle that brought one would say it of another's folder.
const OURS: [&str; 2] = ["kake.toml", "kake.lock"];

/// Characters of base64 on a line.
const LINE: usize = 100;

/// How comments begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sign {
    /// `//`, in .kake
    Slashes,
    /// `#`, in .toml
    Hash,
}

impl Sign {
    /// Every one.
    const ALL: [Self; 2] = [Self::Slashes, Self::Hash];

    fn text(self) -> &'static str {
        match self {
            Self::Slashes => "//",
            Self::Hash => "#",
        }
    }
}

/// What a scene comes with.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Bundle {
    /// The scene's path from its root.
    pub scene: String,
    /// The paths and bytes of the files that it reads, each path once. Standard libraries are called `std:name`, files of
    /// dependencies `key:path`.
    pub files: Vec<(String, Vec<u8>)>,
    /// Keys of dependencies that go by another, shorter one.
    pub dependencies: BTreeMap<String, String>,
}

/// Why a bundle cannot be read or made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BundleError {
    /// The line that is at fault, from 1; none where it is no single one.
    pub line: Option<usize>,
    /// What is wrong with it.
    pub words: String,
}

impl fmt::Display for BundleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "line {line}: {}", self.words),
            None => f.write_str(&self.words),
        }
    }
}

/// The scene's own part of a text, and what follows it: nothing where it is no bundle.
#[must_use]
pub fn split(text: &str) -> (&str, &str) {
    let starts = Sign::ALL.into_iter().filter_map(|sign| start(text, sign));
    text.split_at(starts.min().unwrap_or(text.len()))
}

/// Where the line behind the scene starts.
fn start(text: &str, sign: Sign) -> Option<usize> {
    let head = format!("{}{ANY_HEAD}", sign.text());
    let mut from = 0;
    loop {
        let at = from + text.get(from..)?.find(&head)?;
        if at == 0 || text.as_bytes().get(at - 1) == Some(&b'\n') {
            return Some(at);
        }
        from = at + head.len();
    }
}

/// Puts a scene and its files into one text.
///
/// # Errors
/// If that is more than a bundle may hold.
pub fn write(text: &str, sign: Sign, bundle: &Bundle) -> Result<String, BundleError> {
    let refuse = |words: String| BundleError { line: None, words };
    let bytes: usize = bundle.files.iter().map(|(_, bytes)| bytes.len()).sum();
    if bytes > LARGEST {
        return Err(refuse(format!("the files have {} MB together; a bundle holds {} MB", bytes >> 20, LARGEST >> 20)));
    }
    if bundle.files.len() > MOST {
        return Err(refuse(format!("the scene reads {} files; a bundle holds {MOST}", bundle.files.len())));
    }
    bundle.files.iter().try_for_each(|(path, _)| check(path)).map_err(refuse)?;
    let sign = sign.text();
    let (scene, _) = split(text);
    let mut out = scene.trim_end_matches('\n').to_owned();
    out += &format!("\n\n{sign}{HEAD}{}\n", quoted(&bundle.scene));
    out +=
        &format!("{sign} All that the scene reads lies below; `kake bundle --extract DIR` puts it back into files.\n");
    for (long, short) in &bundle.dependencies {
        out += &format!("{sign} library {} is {}\n", quoted(long), quoted(short));
    }
    for (path, bytes) in &bundle.files {
        match legible(bytes) {
            Some(text) => {
                out += &format!("{sign} file {}, text\n", quoted(path));
                for line in text.lines() {
                    out += &format!("{sign}| {line}\n");
                }
            }
            None => {
                out += &format!("{sign} file {}, base64, {} bytes\n", quoted(path), bytes.len());
                let code = BASE64.encode(bytes);
                for line in code.as_bytes().chunks(LINE) {
                    out += &format!("{sign}: {}\n", String::from_utf8_lossy(line));
                }
            }
        }
    }
    out += &format!("{sign}{END}\n");
    Ok(out)
}

/// The text of a file, if it comes back as it is when it is cut into lines: whole lines, without a carriage return, a
/// control character or white space at the end of a line, which editors take away.
fn legible(bytes: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(bytes).ok()?;
    let is_plain = |c: char| c == '\n' || c == '\t' || !c.is_control() && c != '\u{feff}';
    let ends = |line: &str| line == line.trim_end();
    let is_whole = text.is_empty() || text.ends_with('\n');
    (is_whole && text.chars().all(is_plain) && text.lines().all(ends)).then_some(text)
}

/// A path as a JSON string: on one line, whatever it is made of.
fn quoted(path: &str) -> String {
    serde_json::Value::from(path).to_string()
}

/// A file while its lines are read.
struct Open {
    /// Where it begins.
    line: usize,
    path: String,
    is_text: bool,
    /// How many bytes there are to be.
    bytes: Option<usize>,
    held: String,
}

/// Takes a bundle apart; nothing where the text is none.
///
/// # Errors
/// The first line that is at fault.
pub fn read(text: &str) -> Result<Option<Bundle>, BundleError> {
    let (scene, rest) = split(text);
    let Some(first) = rest.lines().next() else { return Ok(None) };
    let sign = if first.starts_with('#') { Sign::Hash } else { Sign::Slashes };
    let mut reader = Reader {
        sign,
        bundle: Bundle::default(),
        known: BTreeSet::new(),
        folders: BTreeSet::new(),
        open: None,
        bytes: 0,
        has_ended: false,
    };
    let before = scene.bytes().filter(|&byte| byte == b'\n').count();
    for (i, line) in rest.lines().enumerate() {
        let number = before + i + 1;
        let read = if i == 0 { reader.head(line) } else { reader.line(line, number) };
        read.map_err(|words| BundleError { line: Some(number), words })?;
    }
    reader.close().map_err(|(line, words)| BundleError { line: Some(line), words })?;
    if !reader.has_ended {
        let words = format!("the bundle was cut short: its last line, `{}{END}`, is missing", sign.text());
        return Err(BundleError { line: None, words });
    }
    Ok(Some(reader.bundle))
}

struct Reader {
    sign: Sign,
    bundle: Bundle,
    /// The paths so far, and the folders that they lead through, without capitals.
    known: BTreeSet<String>,
    folders: BTreeSet<String>,
    open: Option<Open>,
    /// The bytes so far, as they stand in the text.
    bytes: usize,
    /// Whether the last line was read.
    has_ended: bool,
}

impl Reader {
    fn head(&mut self, line: &str) -> Result<(), String> {
        let rest = line.strip_prefix(self.sign.text()).unwrap_or_default();
        let Some(path) = rest.strip_prefix(HEAD) else {
            let version = rest.trim_start_matches(ANY_HEAD).split(' ').next().unwrap_or_default();
            return Err(format!("this program reads bundles of the form 1, not `{version}`"));
        };
        self.bundle.scene = unquoted(path)?;
        check(&self.bundle.scene)?;
        if !loader::split(&self.bundle.scene).0.is_empty() || self.bundle.scene.contains(':') {
            return Err(format!("`{}` is no path of a scene", self.bundle.scene));
        }
        let scene = self.bundle.scene.clone();
        self.claim(&scene)
    }

    /// Takes a path, unless another stands in its way where capitals make no difference.
    fn claim(&mut self, path: &str) -> Result<(), String> {
        let path_key = path.to_lowercase();
        let folders = || path_key.match_indices('/').map(|(at, _)| &path_key[..at]);
        if self.known.contains(&path_key) {
            return Err(format!("`{path}` is there twice"));
        }
        if self.folders.contains(&path_key) || folders().any(|folder| self.known.contains(folder)) {
            return Err(format!("`{path}` is a file and a folder at once"));
        }
        self.folders.extend(folders().map(str::to_owned));
        self.known.insert(path_key);
        Ok(())
    }

    fn line(&mut self, line: &str, number: usize) -> Result<(), String> {
        if line.trim().is_empty() {
            return Ok(());
        }
        let strange = || "behind a bundle's first file nothing may stand but its files".to_owned();
        if self.has_ended {
            return Err("behind a bundle's last line nothing may stand".to_owned());
        }
        let rest = line.strip_prefix(self.sign.text()).ok_or_else(strange)?;
        let content = |rest: &str| rest.strip_prefix(' ').unwrap_or(rest).to_owned();
        if let Some(rest) = rest.strip_prefix('|') {
            return self.push(true, &format!("{}\n", content(rest)));
        }
        if let Some(rest) = rest.strip_prefix(':') {
            return self.push(false, content(rest).trim());
        }
        self.close().map_err(|(_, words)| words)?;
        if rest == END {
            self.has_ended = true;
            Ok(())
        } else if let Some(rest) = rest.strip_prefix(" file ") {
            self.file(rest, number)
        } else if let Some(rest) = rest.strip_prefix(" library ") {
            let (long, short) = rest.split_once(" is ").ok_or("a library has a name and another: \"a/b\" is \"b\"")?;
            let (long, short) = (unquoted(long)?, unquoted(short)?);
            if ![&long, &short].into_iter().all(|key| key.split('/').all(loader::is_name)) {
                return Err(format!("`{long}` or `{short}` is no name of a library"));
            }
            self.bundle.dependencies.insert(long, short);
            Ok(())
        } else if self.bundle.files.is_empty() && self.open.is_none() {
            // A remark.
            Ok(())
        } else {
            Err(strange())
        }
    }

    /// A line of a file.
    fn push(&mut self, is_text: bool, content: &str) -> Result<(), String> {
        self.bytes += content.len();
        // In base64 four characters are three bytes.
        if self.bytes > LARGEST / 3 * 4 + LARGEST / 64 {
            return Err(format!("the files have more than {} MB together", LARGEST >> 20));
        }
        match &mut self.open {
            Some(open) if open.is_text == is_text => open.held += content,
            Some(open) => return Err(format!("`{}` is text and base64 at once", open.path)),
            None => return Err("these lines belong to no file".to_owned()),
        }
        Ok(())
    }

    /// The line that a file begins with.
    fn file(&mut self, rest: &str, number: usize) -> Result<(), String> {
        let end = rest.rfind('"').map_or(0, |end| end + 1);
        let (path, kind) = rest.split_at(end);
        let path = unquoted(path)?;
        check(&path)?;
        self.claim(&path)?;
        if self.known.len() > MOST + 1 {
            return Err(format!("there are more than {MOST} files"));
        }
        let bytes = |kind: &str| kind.strip_prefix(", base64, ")?.strip_suffix(" bytes")?.parse().ok();
        let (is_text, bytes) = match (kind, bytes(kind)) {
            (", text", _) => (true, None),
            (_, Some(bytes)) => (false, Some(bytes)),
            _ => return Err(format!("`{path}` is neither `text` nor `base64, N bytes`")),
        };
        self.open = Some(Open { line: number, path, is_text, bytes, held: String::new() });
        Ok(())
    }

    /// Ends the file that is open.
    fn close(&mut self) -> Result<(), (usize, String)> {
        let Some(open) = self.open.take() else { return Ok(()) };
        let bytes = match open.bytes {
            None => open.held.into_bytes(),
            Some(wanted) => match BASE64.decode(open.held) {
                Ok(bytes) if bytes.len() == wanted => bytes,
                Ok(bytes) => {
                    let words =
                        format!("`{}` has {} bytes and not {wanted}: lines are missing", open.path, bytes.len());
                    return Err((open.line, words));
                }
                Err(_) => return Err((open.line, format!("`{}` is damaged: it is no base64", open.path))),
            },
        };
        self.bundle.files.push((open.path, bytes));
        Ok(())
    }
}

fn unquoted(text: &str) -> Result<String, String> {
    serde_json::from_str(text.trim()).map_err(|_| format!("`{}` is no path between quotes", text.trim()))
}

/// Whether a path stays in the bundle, on every system.
fn check(path: &str) -> Result<(), String> {
    let shown = path.escape_debug();
    if path.len() > LONGEST_PATH {
        return Err(format!("a path has more than {LONGEST_PATH} characters"));
    }
    let inside = match path.strip_prefix("std:") {
        Some(library) => library,
        None => loader::split(path).1,
    };
    if inside.split('/').any(|part| part == "..") || inside.starts_with('/') || inside.contains(['\\', ':']) {
        return Err(format!("`{shown}` leads out of the bundle"));
    }
    // What begins with a point configures programs, git first of all, which has a second name on some systems.
    let is_hidden = |part: &str| part.starts_with('.') || part.to_ascii_lowercase().starts_with("git~");
    if inside.split('/').any(is_hidden) {
        return Err(format!("`{shown}` is hidden: bundles hold no such files"));
    }
    let is_bad = |part: &str| part.is_empty() || part.len() > LONGEST_PART || part.ends_with([' ', '.']);
    if inside.split('/').any(|part| is_bad(part) || is_device(part)) || inside.chars().any(char::is_control) {
        return Err(format!("`{shown}` is no path of a file"));
    }
    if inside.rsplit('/').next().is_some_and(|name| OURS.iter().any(|ours| name.eq_ignore_ascii_case(ours))) {
        return Err(format!("`{shown}` is nothing that a scene reads"));
    }
    Ok(())
}

/// Whether Windows takes a name for a device.
fn is_device(part: &str) -> bool {
    let stem = part.split('.').next().unwrap_or_default().to_ascii_lowercase();
    let numbered =
        |name: &str| stem.strip_prefix(name).is_some_and(|n| n.len() == 1 && n.as_bytes()[0].is_ascii_digit());
    matches!(&*stem, "con" | "prn" | "aux" | "nul") || numbered("com") || numbered("lpt")
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    const SCENE: &str = "import \"lib/a.kake\"\n// a comment\npaint canvas with a\n";

    fn sample() -> Bundle {
        Bundle {
            scene: "scenes/night.kake".to_owned(),
            files: vec![
                ("lib/a.kake".to_owned(), b"edition 1\n\n// kake bundle 1 \"x\"\n\ttone a {}\n".to_vec()),
                ("ink:tones/\u{5f71}.kake".to_owned(), b"let a = 1\r\n".to_vec()),
                ("std:manga".to_owned(), Vec::new()),
                ("photo \"1\".png".to_owned(), (0..=255).cycle().take(1000).collect()),
            ],
            dependencies: [("ink/base".to_owned(), "base".to_owned())].into(),
        }
    }

    fn refused(lines: &[&str]) -> String {
        let text = format!("{SCENE}\n// kake bundle 1 \"a.kake\"\n{}\n", lines.join("\n"));
        read(&text).unwrap_err().to_string()
    }

    #[test]
    fn bundles_come_back_and_begin_with_their_scene() {
        for sign in Sign::ALL {
            let text = write(SCENE, sign, &sample()).unwrap();
            assert!(text.starts_with(SCENE));
            assert!(text.lines().skip(3).all(|line| line.is_empty() || line.starts_with(sign.text())));
            assert_eq!(read(&text).unwrap(), Some(sample()));
            assert_eq!(split(&text).0.trim_end(), SCENE.trim_end());
            // A bundle of a bundle is one.
            assert_eq!(write(&text, sign, &sample()).unwrap(), text);
        }
    }

    #[test]
    fn what_is_no_bundle_is_none() {
        assert_eq!(read(SCENE), Ok(None));
        assert_eq!(read(""), Ok(None));
        assert_eq!(read("let a = \"// kake bundle 1 x\"\n"), Ok(None));
    }

    #[test]
    fn editors_that_trim_lines_do_no_harm() {
        let text = write(SCENE, Sign::Slashes, &sample()).unwrap();
        let trimmed: String = text.lines().map(|line| format!("{}\r\n", line.trim_end())).collect();
        assert_eq!(read(&trimmed).unwrap(), Some(sample()));
        assert_eq!(read(&format!("{text}\n\n")).unwrap(), Some(sample()));
    }

    #[test]
    fn hostile_bundles_are_refused_at_their_line() {
        for (lines, words) in [
            (&["// file \"../x.kake\", text"][..], "line 6: `../x.kake` leads out of the bundle"),
            (&["// file \"/etc/passwd\", text"], "leads out"),
            (&["// file \"a\\\\..\\\\b\", text"], "leads out"),
            (&["// file \"C:x.kake\", text"], "leads out"),
            (&["// file \"ink:../x.kake\", text"], "leads out"),
            (&["// file \"std:../x\", text"], "leads out"),
            (&["// file \"a//b.kake\", text"], "no path of a file"),
            (&["// file \"a\\u0000.kake\", text"], "no path of a file"),
            (&["// file \".git/config\", text"], "is hidden"),
            (&["// file \"ink:a/.GIT/config\", text"], "is hidden"),
            (&["// file \"GIT~1/config\", text"], "is hidden"),
            (&["// file \"a/con.txt\", text"], "no path of a file"),
            (&["// file \"lib/kake.toml\", text"], "nothing that a scene reads"),
            (&["// file \"tones\", text", "// file \"tones/w.kake\", text"], "a file and a folder"),
            (&["// file \"tones/w.kake\", text", "// file \"Tones\", text"], "a file and a folder"),
            (&["// file \"t/w.kake\", text", "// file \"T/w.kake\", text"], "there twice"),
            (&["// file \"b\", text", "//| x", "// file \"b\", text"], "line 8: `b` is there twice"),
            (&["// file \"a.kake\", text"], "there twice"),
            (&["// file b, text"], "no path between quotes"),
            (&["// file \"b\", zip"], "neither `text` nor"),
            (&["//| x"], "belong to no file"),
            (&["// file \"b\", text", "//: eA=="], "text and base64 at once"),
            (&["// file \"b\", base64, 2 bytes", "//: eA=="], "line 6: `b` has 1 bytes and not 2"),
            (&["// file \"b\", base64, 2 bytes", "//: !!"], "no base64"),
            (&["paint canvas with b"], "nothing may stand but its files"),
            (&["// end of the bundle", "// file \"b\", text"], "behind a bundle's last line"),
            (&["// file \"b\", text", "//| x"], "was cut short"),
            (&["// library \"a b\" is \"c\""], "no name of a library"),
        ] {
            let said = refused(lines);
            assert!(said.contains(words), "{lines:?}: {said}");
        }
        let newer = read("// kake bundle 2 \"a.kake\"\n").unwrap_err().to_string();
        assert!(newer.contains("not `2`"), "{newer}");
        assert!(read("// kake bundle 1 \"../a.kake\"\n").is_err());
        let mut many = Bundle { scene: "a.kake".to_owned(), ..Bundle::default() };
        many.files = (0..=MOST).map(|i| (format!("f{i}"), Vec::new())).collect();
        assert!(write(SCENE, Sign::Slashes, &many).is_err());
    }

    proptest! {
        #[test]
        fn any_file_comes_back(files in vec(("[a-z]{1,9}", prop_oneof![vec(any::<u8>(), 0..300), "\\PC{0,40}\n".prop_map(String::into_bytes)]), 0..6)) {
            let mut bundle = sample();
            bundle.files = files.into_iter().enumerate().map(|(i, (path, bytes))| (format!("d/{path}{i}"), bytes)).collect();
            let text = write(SCENE, Sign::Hash, &bundle).unwrap();
            prop_assert_eq!(read(&text), Ok(Some(bundle)));
        }

        #[test]
        fn damage_is_survived(at in any::<prop::sample::Index>(), with in "\\PC{0,3}") {
            let mut text = write(SCENE, Sign::Slashes, &sample()).unwrap();
            let mut at = at.index(text.len());
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            text.insert_str(at, &with);
            let _ = read(&text);
        }
    }
}
