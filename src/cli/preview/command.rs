//! The command line that makes what is shown.

use crate::Config;

use super::session::Session;

/// `kake build …`, to be pasted into a shell.
pub(super) fn command(session: &Session, config: &Config) -> String {
    let settings = &session.settings;
    let mut words = vec!["kake".to_owned(), "build".to_owned(), operand(&settings.given.to_string_lossy())];
    for (name, value) in &config.lower.sets {
        words.extend(["--set".to_owned(), quoted(&format!("{name}={value}"))]);
    }
    if let Some(seed) = config.lower.seed {
        words.extend(["--seed".to_owned(), seed.to_string()]);
    }
    if let Some(only) = &config.only {
        words.push(format!("--only={}", quoted(only)));
    }
    if !config.overlays.is_empty() {
        let names: Vec<&str> = config.overlays.iter().map(|overlay| overlay.name()).collect();
        words.extend(["--overlay".to_owned(), names.join(",")]);
    }
    words.extend(settings.arguments.iter().map(|argument| quoted(argument)));
    words.extend(["-o".to_owned(), operand(&format!("{}.svg", session.stem()))]);
    words.join(" ")
}

/// A file's name that is not taken for an option.
fn operand(path: &str) -> String {
    if path.starts_with('-') { quoted(&format!("./{path}")) } else { quoted(path) }
}

/// A word as shells read it: quoted where it holds more than letters, digits and signs that mean nothing to them.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_-./=:,%+@".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    if cfg!(windows) {
        format!("\"{}\"", word.replace('"', "\\\""))
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn words_are_quoted_for_the_shell() {
        for (word, wanted) in [
            ("tile=4mm", "tile=4mm"),
            ("share=50%", "share=50%"),
            ("ink=#333333", "'ink=#333333'"),
            ("name=it's", r"'name=it'\''s'"),
            ("a b", "'a b'"),
            ("", "''"),
            ("$(rm)", "'$(rm)'"),
        ] {
            assert_eq!(quoted(word), wanted);
        }
        assert_eq!(operand("-scene.kake"), "./-scene.kake");
    }
}
