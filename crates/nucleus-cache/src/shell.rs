//! Paths in commands that messages print, so that a reader can copy the command.

use std::path::Path;

/// A path as one word of a shell: in quotes if it has blanks or characters that a shell reads otherwise, and with `./` if it
/// would be read as an option.
///
/// ```
/// # use std::path::Path;
/// # use nucleus_cache::shell_word;
/// assert_eq!(shell_word(Path::new("shots/cape.ron")), "shots/cape.ron");
/// # #[cfg(unix)]
/// assert_eq!(shell_word(Path::new("my dir/it's.ron")), r"'my dir/it'\''s.ron'");
/// ```
pub fn shell_word(path: &Path) -> String {
    let text = path.to_string_lossy();
    let text = if text.starts_with('-') { format!("./{text}") } else { text.into_owned() };
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+,=@%:".contains(c) || cfg!(windows) && c == '\\';
    match () {
        () if !text.is_empty() && text.chars().all(is_plain) => text,
        // No path of Windows has a double quote.
        () if cfg!(windows) => format!("\"{text}\""),
        () => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_quoted_where_a_shell_would_split_or_expand_it() {
        for (path, word) in [
            ("a.ron", "a.ron"),
            ("dir/größe-1.mcap.part", "dir/größe-1.mcap.part"),
            ("shot 1.ron", "'shot 1.ron'"),
            ("$HOME/*.ron", "'$HOME/*.ron'"),
            ("~/a.ron", "'~/a.ron'"),
            ("it's", r"'it'\''s'"),
            ("", "''"),
            ("-dash.mcap", "./-dash.mcap"),
            ("-a b", "'./-a b'"),
            ("a-b", "a-b"),
        ] {
            assert_eq!(shell_word(Path::new(path)), word);
        }
    }
}
