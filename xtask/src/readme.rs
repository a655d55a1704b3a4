//! The shell commands of the README.

/// The commands of the first shell block, without comments and prompts.
pub fn commands(page: &str) -> Vec<String> {
    let mut block = page.lines().skip_while(|line| !opens_shell_block(line)).skip(1);
    let lines = block.by_ref().take_while(|line| !line.starts_with("```"));
    let commands =
        lines.map(|line| line.split(" # ").next().unwrap_or_default().trim().trim_start_matches("$ "));
    commands.filter(|command| !command.is_empty() && !command.starts_with('#')).map(str::to_owned).collect()
}

fn opens_shell_block(line: &str) -> bool {
    matches!(line.trim(), "```sh" | "```bash" | "```shell" | "```console")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_the_lines_of_the_first_shell_block() {
        let page = "# Nucleus\n```ron\nScene()\n```\n```sh\n# drape\n$ cargo run -- run a.ron  # half a minute\n\n\
            cargo run -- play a.mcap\n```\n```sh\nrm everything\n```\n";
        assert_eq!(commands(page), ["cargo run -- run a.ron", "cargo run -- play a.mcap"]);
    }

    #[test]
    fn a_page_without_a_shell_block_has_no_commands() {
        assert_eq!(commands("# Nucleus\n```\ntext\n```\n"), [""; 0]);
    }
}
