//! Where the model's text comes from: a file beside the calling one, or the braces of the macro itself.

use proc_macro::{Span, TokenStream, TokenTree};
use std::path::{Path, PathBuf};

/// A model's text and how its places map to tokens.
pub struct Input {
    /// Name shown in messages.
    pub name: String,
    /// File that `extend` and `use` paths are relative to.
    pub file: PathBuf,
    /// The text; an inline model keeps the line numbers of the file around it.
    pub text: String,
    /// Tokens with the byte of `text` where each starts; empty for a model in a file.
    pub tokens: Vec<(usize, Span)>,
    /// Whether the text was read from its own file.
    pub in_file: bool,
}

/// What went wrong before the compiler could start, and where.
pub type Refusal = (String, Span);

/// `include_model!("path")`.
pub fn included(input: TokenStream) -> Result<Input, Refusal> {
    let call = Span::call_site();
    let text = input.to_string();
    let path = text.trim().strip_prefix('"').and_then(|t| t.strip_suffix('"'));
    let path = path.ok_or((String::from("write include_model!(\"path/to/model.ansatz\")"), call))?;
    let folder = call.local_file().and_then(|f| f.parent().map(Path::to_path_buf)).unwrap_or_default();
    let file = folder.join(path);
    let text = std::fs::read_to_string(&file)
        .map_err(|e| (format!("cannot read the model `{}`: {e}", file.display()), call))?;
    Ok(Input { name: path.into(), file, text, tokens: Vec::new(), in_file: true })
}

/// `model! { .. }`: the text of the file between the first and the last token.
pub fn written(input: TokenStream) -> Result<Input, Refusal> {
    let call = Span::call_site();
    let trees: Vec<TokenTree> = input.into_iter().collect();
    let (Some(first), Some(last)) = (trees.first(), trees.last()) else {
        return Err((String::from("the model is empty; it starts with `model name;`"), call));
    };
    let file = first.span().local_file();
    let file =
        file.ok_or((String::from("the model's text is not in a file of its own; use include_model!"), call))?;
    let whole = std::fs::read_to_string(&file)
        .map_err(|e| (format!("cannot read `{}`: {e}", file.display()), call))?;
    let lines = line_starts(&whole);
    let start = byte_at(&whole, &lines, first.span().start());
    let end = byte_at(&whole, &lines, last.span().end());
    let mut tokens = Vec::new();
    collect(&whole, &lines, trees, &mut tokens);
    Ok(Input {
        name: file.display().to_string(),
        text: blanked(&whole, start, end),
        file,
        tokens,
        in_file: false,
    })
}

/// The text with everything outside `start .. end` blanked, line breaks kept.
fn blanked(whole: &str, start: usize, end: usize) -> String {
    let blank = |part: &str| part.bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }).collect::<String>();
    format!("{}{}", blank(&whole[..start]), &whole[start..end])
}

fn line_starts(text: &str) -> Vec<usize> {
    std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect()
}

/// Byte of a place; lines and columns count from 1, columns in characters.
fn byte_at(text: &str, lines: &[usize], place: Span) -> usize {
    let line = lines.get(place.line().saturating_sub(1)).copied().unwrap_or(text.len());
    let rest = &text[line..];
    line + rest.char_indices().nth(place.column().saturating_sub(1)).map_or(rest.len(), |(i, _)| i)
}

fn collect(text: &str, lines: &[usize], trees: Vec<TokenTree>, tokens: &mut Vec<(usize, Span)>) {
    for tree in trees {
        tokens.push((byte_at(text, lines, tree.span().start()), tree.span()));
        if let TokenTree::Group(group) = tree {
            collect(text, lines, group.stream().into_iter().collect(), tokens);
        }
    }
}
