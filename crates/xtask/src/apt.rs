//! Programs that tests need, from the system's packages.

use std::process::{Command, Stdio};

use crate::Outcome;
use crate::process::{command, run};

/// Something that is installed from packages of Debian and Ubuntu.
pub struct Needed {
    /// What it is, in words.
    pub what: &'static str,
    /// The program by which it is known elsewhere.
    pub program: &'static str,
    /// The packages.
    pub packages: &'static [&'static str],
}

impl Needed {
    /// Installs what is missing where apt can; elsewhere the program must be there.
    ///
    /// # Errors
    /// Say what to install.
    pub fn ensure(&self) -> Outcome {
        let mut query = Command::new("dpkg-query");
        query.args(["--show", "--showformat=${Package} ${db:Status-Status}\n"]).args(self.packages);
        let Ok(known) = query.stderr(Stdio::null()).output() else {
            return if is_there(self.program) { Ok(()) } else { Err(self.wanted("there is no dpkg to ask")) };
        };
        let missing = self.missing(&String::from_utf8_lossy(&known.stdout));
        if missing.is_empty() {
            return Ok(());
        }
        let apt = |arguments: &[&str]| {
            let mut apt = as_root("apt-get").map_err(|error| self.wanted(&error))?;
            run(apt.args(arguments)).map_err(|error| self.wanted(&error))
        };
        apt(&["update", "--quiet"])?;
        apt(&[&["install", "--yes", "--quiet", "--no-install-recommends"][..], &missing].concat())
    }

    /// What `dpkg-query` does not call installed.
    fn missing(&self, known: &str) -> Vec<&'static str> {
        let is_installed = |package: &&str| known.lines().any(|line| line == format!("{package} installed"));
        self.packages.iter().copied().filter(|package| !is_installed(package)).collect()
    }

    /// The message of someone who lacks it.
    pub fn wanted(&self, why: &str) -> String {
        let (what, packages) = (self.what, self.packages.join(" "));
        format!("{what} wanted ({why}); on Debian and Ubuntu: apt-get install {packages}")
    }
}

/// Whether a program is on the path.
pub fn is_there(program: &str) -> bool {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&folders).any(|folder| folder.join(program).is_file())
}

/// A command that may install: by sudo, without a question that nobody would answer, unless root asks.
fn as_root(program: &str) -> Result<Command, String> {
    let user = Command::new("id").arg("-u").output().map_err(|error| format!("id: {error}"))?;
    if user.stdout.trim_ascii() == b"0" {
        return Ok(command(program, &[]));
    }
    Ok(command("sudo", &["--non-interactive", program]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAIR: Needed = Needed { what: "a pair is", program: "pair", packages: &["one", "two"] };

    #[test]
    fn what_is_half_installed_or_unknown_is_missing() {
        assert_eq!(PAIR.missing("two installed\n"), ["one"]);
        assert_eq!(PAIR.missing("one config-files\ntwo installed\n"), ["one"]);
        assert!(PAIR.missing("one installed\ntwo installed\n").is_empty());
    }

    #[test]
    fn a_machine_where_nothing_can_be_installed_is_told_what_to_do() {
        let message = PAIR.wanted("no apt");
        assert_eq!(message, "a pair is wanted (no apt); on Debian and Ubuntu: apt-get install one two");
    }
}
