//! Messages as they go over the line: headers, a blank line, JSON.
//!
//! What is no message is told from the end of the input, so that a client's slip does not end the session. The types of
//! messages are lsp-server's; its own reader ends at the first slip and makes room for any length that is announced.

use std::io::{self, BufRead, Read, Write};

use lsp_server::Message;
use serde_json::{Value, json};

/// The longest message that is read.
const LONGEST: u64 = 256 << 20;
/// The longest line of a header.
const LONGEST_LINE: u64 = 8192;

/// What comes in.
#[derive(Debug)]
pub(super) enum Incoming {
    Message(Message),
    /// Something else, and why it is no message.
    Nonsense(String),
    /// No more will come.
    End,
}

/// Reads one message.
pub(super) fn read(input: &mut impl BufRead) -> Incoming {
    let mut length: Option<u64> = None;
    let mut saw = false;
    loop {
        let mut line = Vec::new();
        match input.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return Incoming::End,
            Ok(_) => {}
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim();
        if text.is_empty() {
            match length {
                Some(_) => break,
                // Blank lines between messages say nothing.
                None if !saw => continue,
                None => return Incoming::Nonsense("a header without Content-Length".to_owned()),
            }
        }
        saw = true;
        if let Some((name, value)) = text.split_once(':')
            && name.trim().eq_ignore_ascii_case("Content-Length")
        {
            length = value.trim().parse().ok();
            if length.is_none() {
                return Incoming::Nonsense(format!("a Content-Length that is no number: {}", value.trim()));
            }
        }
    }
    let length = length.unwrap_or(0);
    let mut body = Vec::new();
    if length > LONGEST {
        // What was announced is passed over, as far as it comes.
        return match io::copy(&mut input.by_ref().take(length), &mut io::sink()) {
            Ok(read) if read == length => Incoming::Nonsense(format!("a message of more than {LONGEST} bytes")),
            _ => Incoming::End,
        };
    }
    match input.by_ref().take(length).read_to_end(&mut body) {
        Ok(read) if read as u64 == length => {}
        _ => return Incoming::End,
    }
    let value: Value = match serde_json::from_slice(&body) {
        Ok(value) => value,
        Err(error) => return Incoming::Nonsense(format!("no message: {error}")),
    };
    let has_id = value.get("id").is_some();
    match serde_json::from_value(value) {
        // Someone waits for an answer to it, and no answer could name it.
        Ok(Message::Notification(_)) if has_id => {
            Incoming::Nonsense("an id is a string or a whole number of 32 bits".to_owned())
        }
        Ok(message) => Incoming::Message(message),
        Err(error) => Incoming::Nonsense(format!("no message: {error}")),
    }
}

/// Writes one message.
///
/// # Errors
/// Where nobody reads any more.
pub(super) fn write(message: Message) -> io::Result<()> {
    message.write(&mut io::stdout().lock())
}

/// Tells that something was no message. Nobody knows which request it would have been.
pub(super) fn refuse(words: &str) -> io::Result<()> {
    let error = json!({ "code": lsp_server::ErrorCode::ParseError as i32, "message": words });
    let body = json!({ "jsonrpc": "2.0", "id": Value::Null, "error": error }).to_string();
    let mut out = io::stdout().lock();
    write!(out, "Content-Length: {}\r\n\r\n{body}", body.len())?;
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_does_not_end_the_session() {
        let good = r#"{"jsonrpc":"2.0","method":"exit"}"#;
        let text = format!(
            "\r\nContent-Length: 3\r\n\r\n{{x}}Content-Type: a\r\n\r\nContent-Length: many\r\n\r\nContent-Length: {}\r\n\r\n{good}",
            good.len()
        );
        let mut input = text.as_bytes();
        let mut kinds = Vec::new();
        loop {
            match read(&mut input) {
                Incoming::Message(_) => kinds.push("message"),
                Incoming::Nonsense(_) => kinds.push("nonsense"),
                Incoming::End => break,
            }
        }
        assert_eq!(kinds, ["nonsense", "nonsense", "nonsense", "message"]);
    }

    #[test]
    fn lengths_that_never_come_end_the_session() {
        let mut input = "Content-Length: 99999999999999999\r\n\r\n{}".as_bytes();
        assert!(matches!(read(&mut input), Incoming::End));
    }
}
