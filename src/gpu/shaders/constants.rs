//! `const uint NAME = 16u;` lines of a room's `constants.glsl` as Rust constants: the numbers that stages and host share.

use anyhow::{Result, anyhow, bail};

/// Rust source of the constants in `text`, the content of the file `name`. A line that does not begin with `const` is
/// left alone; comment lines just above a constant, or the comment behind it, become its documentation.
///
/// # Errors
/// One sentence with file and line for a constant of another type than uint, int, float or bool, or a value that is not
/// made of numbers, earlier constants, brackets and operators.
pub fn constants(name: &str, text: &str) -> Result<String> {
    let mut source = String::new();
    let mut comment: Vec<&str> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        let at = format!("{name}:{}", index + 1);
        if let Some(text) = line.strip_prefix("//") {
            comment.push(text.trim());
            continue;
        }
        if let Some(declaration) = line.strip_prefix("const ") {
            let (declaration, behind) = declaration.split_once("//").unwrap_or((declaration, ""));
            let one_line =
                || anyhow!("{at}: expected one constant on one line, such as const uint COUNT = 16u; found {line}");
            let declaration = declaration.trim().strip_suffix(';').ok_or_else(one_line)?;
            let (left, value) = declaration.split_once('=').ok_or_else(one_line)?;
            let (glsl, own) = left.trim().split_once(' ').ok_or_else(one_line)?;
            let own = own.trim();
            let ty = match glsl {
                "uint" => "u32",
                "int" => "i32",
                "float" => "f32",
                "bool" => "bool",
                other => bail!("{at}: {own} is a {other}, and Rust shares only uint, int, float and bool constants"),
            };
            if own.is_empty() || !own.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_') {
                bail!("{at}: expected a name in capitals, found {own}");
            }
            if !behind.is_empty() {
                comment.push(behind.trim());
            }
            let own_words = format!("`{own}` of `{name}`.");
            let docs = if comment.is_empty() { vec![own_words.as_str()] } else { comment.clone() };
            for line in docs {
                source += &format!("/// {line}\n");
            }
            source += &format!(
                "#[allow(dead_code, unreachable_pub, reason = \"written by the build\")]\npub const {own}: {ty} = {};\n",
                expression(&at, value, ty)?
            );
        }
        comment.clear();
    }
    Ok(source)
}

/// The GLSL expression in Rust: numbers lose their suffixes, the rest reads the same in both.
fn expression(at: &str, value: &str, ty: &str) -> Result<String> {
    let mut source = String::new();
    let mut rest = value.trim();
    while let Some(first) = rest.chars().next() {
        let word =
            |part: &str| part.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_' || *c == '.').count();
        if first.is_ascii_digit() || first == '.' {
            let mut length = word(rest);
            // The sign of an exponent belongs to the number: 1e-3.
            let exponent = !rest.starts_with("0x") && rest[..length].ends_with(['e', 'E']);
            if exponent && rest[length..].starts_with(['+', '-']) {
                length += 1 + word(&rest[length + 1..]);
            }
            source += &number(&rest[..length], ty).ok_or_else(|| anyhow!("{at}: {} is not a {ty}", &rest[..length]))?;
            rest = &rest[length..];
        } else if first.is_ascii_alphabetic() || first == '_' {
            let length = word(rest);
            if rest[length..].trim_start().starts_with('(') {
                bail!(
                    "{at}: {} is a function, and a shared constant is made of numbers, names and operators",
                    &rest[..length]
                );
            }
            source += &rest[..length];
            rest = &rest[length..];
        } else if "+-*/%<>&|^()! ".contains(first) {
            source.push(first);
            rest = &rest[1..];
        } else {
            bail!("{at}: {first} does not belong into a shared constant");
        }
    }
    if source.is_empty() {
        bail!("{at}: the constant has no value");
    }
    Ok(source)
}

fn number(glsl: &str, ty: &str) -> Option<String> {
    if ty == "f32" {
        let value: f32 = glsl.trim_end_matches(['f', 'F']).parse().ok()?;
        return value.is_finite().then(|| format!("{value:?}"));
    }
    let digits = glsl.trim_end_matches(['u', 'U']);
    let value = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        Some(hex) => u32::from_str_radix(hex, 16).ok()?,
        // GLSL reads 017 as octal; Rust would not.
        None if digits.len() > 1 && digits.starts_with('0') => u32::from_str_radix(digits, 8).ok()?,
        None => digits.parse().ok()?,
    };
    Some(value.to_string())
}
