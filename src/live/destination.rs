//! Where poses go, as `--send` names it.

use std::fmt;
use std::str::FromStr;

use anyhow::{Context, Result, anyhow, ensure};

use crate::files::{choices, shortened};

choices! {
    /// How poses are told.
    "scheme" pub enum Scheme {
        /// Virtual Motion Capture protocol (OSC over UDP), to the application that receives at the address.
        "vmc" Vmc,
        /// A line of JSON a pose, over TCP, to whoever connects to the address.
        "jsonl" Jsonl,
    }
}

/// Where poses go: `jsonl://127.0.0.1:5005`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    /// How they are told.
    pub scheme: Scheme,
    /// A name or a number; a number of IPv6 without its brackets.
    pub host: String,
    /// The port.
    pub port: u16,
}

impl FromStr for Destination {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let shown = shortened(text);
        let (scheme, rest) = text.split_once("://").ok_or_else(|| {
            anyhow!("`{shown}` is no destination, expected SCHEME://HOST:PORT, as vmc://127.0.0.1:39539")
        })?;
        let scheme = Scheme::from_name(scheme)?;
        let wrong = |found: &str| anyhow!("`{shown}` {found}, expected {scheme}://HOST:PORT");
        let rest = rest.strip_suffix('/').unwrap_or(rest);
        let (host, port) = match rest.strip_prefix('[') {
            Some(bracketed) => {
                let (host, port) =
                    bracketed.split_once(']').ok_or_else(|| wrong("has a bracket that does not close"))?;
                (host, port.strip_prefix(':').ok_or_else(|| wrong("names no port"))?)
            }
            None => rest.rsplit_once(':').ok_or_else(|| wrong("names no port"))?,
        };
        ensure!(!host.is_empty(), wrong("names no host"));
        ensure!(rest.starts_with('[') || !host.contains(':'), wrong("has an address of IPv6 without its brackets"));
        let is_name = host.chars().all(|c| c.is_alphanumeric() || "-_.:%".contains(c));
        ensure!(is_name, wrong("has a host that is none"));
        let port =
            port.parse().ok().with_context(|| wrong("has a port that is no number from 0 to 65535").to_string())?;
        Ok(Self { scheme, host: host.to_string(), port })
    }
}

impl fmt::Display for Destination {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scheme, host, port } = self;
        if host.contains(':') {
            write!(out, "{scheme}://[{host}]:{port}")
        } else {
            write!(out, "{scheme}://{host}:{port}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn destinations_read_back_as_they_are_written() {
        for text in ["jsonl://127.0.0.1:5005", "jsonl://localhost:0", "vmc://[::1]:65535"] {
            let read: Destination = text.parse().unwrap();
            assert_eq!(read.to_string(), text);
        }
        let read: Destination = "jsonl://[fe80::1]:7/".parse().unwrap();
        assert_eq!((read.host.as_str(), read.port), ("fe80::1", 7));
    }

    #[test]
    fn what_is_no_destination_is_said() {
        for (text, part) in [
            ("localhost:5005", "`localhost:5005` is no destination, expected SCHEME://HOST:PORT"),
            ("json://localhost:5", "unknown scheme `json`, the nearest is `jsonl` (known: vmc, jsonl)"),
            ("jsonl://localhost", "names no port, expected jsonl://HOST:PORT"),
            ("jsonl://:5005", "names no host"),
            ("jsonl://localhost:port", "has a port that is no number from 0 to 65535"),
            ("jsonl://localhost:65536", "has a port that is no number"),
            ("jsonl://::1:5", "IPv6 without its brackets"),
            ("jsonl://[::1:5", "has a bracket that does not close"),
            ("jsonl://[::1]", "names no port"),
            ("jsonl://a/b:5", "has a host that is none"),
        ] {
            let error = text.parse::<Destination>().unwrap_err().to_string();
            assert!(error.contains(part), "{error}\nshould say: {part}");
        }
    }
}
