//! How git calls a program that shows differences: as a tool with two files, or as a driver with seven, eight or nine
//! arguments (gitattributes and git's own documentation of `GIT_EXTERNAL_DIFF`), one where a path is not merged.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

/// What a driver is given at most.
const MOST: usize = 9;

/// What is compared.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Call {
    /// Two scenes.
    Pair([OsString; 2]),
    /// Two versions of a file, as a driver is given them.
    Driver(Box<[Version; 2]>),
    /// A path that is not merged yet.
    Unmerged(PathBuf),
}

/// A version of a file, as a driver is given it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Version {
    /// Where it lies in the repository.
    pub(super) path: PathBuf,
    /// A file that holds it: a copy, the file itself, or the null device.
    pub(super) file: PathBuf,
    /// Its blob, in hexadecimal digits; a dot where there is none, and zeros where it is not known.
    pub(super) hex: String,
    /// Its mode; a dot where there is none.
    pub(super) mode: String,
}

impl Version {
    /// Whether there is no such version: the file came or went.
    pub(super) fn is_nothing(&self) -> bool {
        self.mode == "."
    }

    /// Whether it is no file but a link or another repository.
    pub(super) fn is_other(&self) -> bool {
        self.mode.starts_with("12") || self.mode.starts_with("16")
    }
}

/// What git says in its environment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Caller {
    /// Nothing: a person or a script calls.
    Nobody,
    /// A driver is called.
    Driver,
    /// A tool is called by its command line, to which git appends two files.
    Tool,
}

impl Caller {
    /// Who calls, as the environment says.
    pub(super) fn new(is_set: impl Fn(&str) -> bool) -> Self {
        if is_set("GIT_DIFFTOOL_EXTCMD") {
            Self::Tool
        } else if is_set("GIT_DIFF_PATH_TOTAL") && !is_set("GIT_DIFF_TOOL") {
            Self::Driver
        } else {
            Self::Nobody
        }
    }
}

/// Puts `--` before what git has appended to a command line, so that no path of a repository is taken for an option.
pub(super) fn guarded(mut arguments: Vec<OsString>, caller: Caller) -> Vec<OsString> {
    let all = arguments.len();
    let room = all.saturating_sub(2);
    let tail = |count: usize| (count <= room).then(|| &arguments[all - count..]);
    let driver = (7..=MOST).find(|&count| tail(count).is_some_and(|tail| driver(tail).is_some()));
    let appended = driver.or(match caller {
        Caller::Nobody => None,
        Caller::Driver => Some(1),
        Caller::Tool => Some(2),
    });
    if let Some(count) = appended.filter(|&count| count <= room)
        && arguments[all - count - 1] != "--"
    {
        arguments.insert(all - count, "--".into());
    }
    arguments
}

/// Makes out what is compared.
pub(super) fn call(arguments: &[OsString], caller: Caller) -> Result<Call, String> {
    match arguments {
        [path] if caller == Caller::Driver => Ok(Call::Unmerged(path.into())),
        [a, b] => Ok(Call::Pair([a.clone(), b.clone()])),
        _ => driver(arguments).map(|versions| Call::Driver(Box::new(versions))).ok_or_else(|| {
            format!(
                "two scenes are compared, and {} given: `kake diff OLD NEW`",
                match arguments.len() {
                    1 => "one is".to_owned(),
                    count => format!("{count} are"),
                }
            )
        }),
    }
}

/// The arguments of a driver: path, then file, blob and mode of the old and of the new version; the new path where it is
/// another one, and a word on how alike they are.
fn driver(arguments: &[OsString]) -> Option<[Version; 2]> {
    let (given, more) = arguments.split_first_chunk::<7>()?;
    let [path, old_file, old_hex, old_mode, new_file, new_hex, new_mode] = given;
    if more.len() > 2 {
        return None;
    }
    let version = |path: &OsStr, file: &OsStr, hex: &OsStr, mode: &OsStr| {
        let (hex, mode) = (hex.to_str()?, mode.to_str()?);
        let is_hex = matches!(hex.len(), 40 | 64) && hex.bytes().all(|digit| digit.is_ascii_hexdigit());
        let is_mode = mode.len() == 6 && mode.bytes().all(|digit| matches!(digit, b'0'..=b'7'));
        ((is_hex || hex == ".") && (is_mode || mode == ".")).then(|| Version {
            path: path.into(),
            file: file.into(),
            hex: hex.to_owned(),
            mode: mode.to_owned(),
        })
    };
    let new_path = more.first().unwrap_or(path);
    Some([version(path, old_file, old_hex, old_mode)?, version(new_path, new_file, new_hex, new_mode)?])
}

/// A side that is written as a revision and a path: `HEAD~2:scene.kake`. What stands in braces holds no end of a revision.
pub(super) fn revision(text: &str) -> Option<(&str, &str)> {
    let mut depth = 0u32;
    for (at, character) in text.char_indices() {
        match character {
            '{' => depth += 1,
            '}' => depth = depth.saturating_sub(1),
            ':' if depth == 0 => return Some((&text[..at], &text[at + 1..])),
            _ => {}
        }
    }
    None
}

/// Whether a file is the null device, by which tools are told that there is none.
pub(super) fn is_null(file: &Path) -> bool {
    file == Path::new("/dev/null") || file == Path::new("nul") || file == Path::new("NUL")
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use super::*;

    const HEX: &str = "0123456789012345678901234567890123456789";

    fn words(text: &[&str]) -> Vec<OsString> {
        text.iter().map(OsString::from).collect()
    }

    #[test]
    fn what_git_appends_is_no_option() {
        let seven = ["-o.kake", "/tmp/x", HEX, "100644", "-o.kake", ".", "."];
        let nine = ["a b", "/tmp/x", HEX, "100644", "/tmp/y", HEX, "100644", "--only", "similarity index 90%\n"];
        for (given, caller, guarded_at) in [
            (&seven[..], Caller::Nobody, Some(0)),
            (&nine[..], Caller::Driver, Some(0)),
            (&["--set", "x=1", "-a", "-b"][..], Caller::Tool, Some(2)),
            (&["-unmerged"][..], Caller::Driver, Some(0)),
            (&["a", "b"][..], Caller::Nobody, None),
            (&["--", "a", "b"][..], Caller::Tool, None),
        ] {
            let before = words(&[&["kake", "diff"], given].concat());
            let after = guarded(before.clone(), caller);
            let found = (after != before).then(|| after.iter().position(|word| word == "--").unwrap() - 2);
            assert_eq!(found, guarded_at, "{given:?}");
        }
        assert_eq!(guarded(words(&["kake", "diff"]), Caller::Tool), words(&["kake", "diff"]));
    }

    #[test]
    fn drivers_are_called_with_seven_to_nine() {
        let seven = words(&["s.kake", "/dev/null", ".", ".", "s.kake", HEX, "100644"]);
        let Ok(Call::Driver(versions)) = call(&seven, Caller::Driver) else { panic!("seven are a driver's") };
        assert!(versions[0].is_nothing() && !versions[1].is_nothing());
        let nine = [seven.clone(), words(&["t.kake", "similarity index 100%\n"])].concat();
        let Ok(Call::Driver(versions)) = call(&nine, Caller::Driver) else { panic!("nine are a driver's") };
        assert_eq!(versions[1].path, Path::new("t.kake"));
        assert_eq!(call(&words(&["a"]), Caller::Driver), Ok(Call::Unmerged("a".into())));
        for wrong in [&seven[..1], &seven[..3], &seven[..6], &[seven.clone(), nine].concat()] {
            assert!(call(wrong, Caller::Nobody).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn revisions_end_at_the_first_colon() {
        assert_eq!(revision("HEAD~2:a/b.kake"), Some(("HEAD~2", "a/b.kake")));
        assert_eq!(revision("HEAD@{1 day 12:30}:b:c.kake"), Some(("HEAD@{1 day 12:30}", "b:c.kake")));
        assert_eq!(revision(":b.kake"), Some(("", "b.kake")));
        assert_eq!(revision("b.kake"), None);
    }
}
