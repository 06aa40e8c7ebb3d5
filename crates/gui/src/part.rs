//! The part of this machine in renders of many, as the controls have it.

use crate::words;
use indigo_front::flags::{Arguments, Role};
use indigo_front::logical_cores;
use indigo_net::limits::PORT;
use indigo_net::slave::{host_and_port, written};
use indigo_scene::Override;

/// See the module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The part; none: this machine renders alone.
    pub role: Option<Role>,
    /// The file of the shared key; empty: only programs of this machine take part.
    pub key_file: String,
    /// Where a master listens.
    pub port: u16,
    /// Where a slave finds its master, as host or host and port; empty: by looking for one in the local network.
    pub host: String,
    /// Threads of a slave.
    pub threads: usize,
}

impl Part {
    /// All parts.
    pub const ROLES: [Option<Role>; 4] =
        [None, Some(Role::Master), Some(Role::WorkingMaster), Some(Role::Slave)];

    /// That of a command line.
    pub fn of(arguments: &Arguments) -> Self {
        let threads = arguments.settings.iter().rev().find(|setting| setting.setting == "num_threads");
        Self {
            role: arguments.network,
            key_file: arguments.key_file.clone().unwrap_or_default(),
            port: arguments.port.unwrap_or(PORT),
            host: arguments.host.as_ref().map(|(host, port)| written(host, *port)).unwrap_or_default(),
            threads: threads.and_then(|t| t.value.parse().ok()).unwrap_or_else(logical_cores),
        }
    }

    /// Whether others render, too.
    pub fn is_master(&self) -> bool {
        matches!(self.role, Some(Role::Master | Role::WorkingMaster))
    }

    /// A command line with this part.
    ///
    /// # Errors
    /// Where the host is none, in words.
    pub fn in_arguments(&self, arguments: &Arguments) -> Result<Arguments, String> {
        let mut arguments = arguments.clone();
        arguments.network = self.role;
        arguments.key_file = Some(self.key_file.clone()).filter(|file| !file.is_empty());
        arguments.port = Some(self.port);
        let name = self.host.trim();
        arguments.host = match host_and_port(name) {
            None if !name.is_empty() => return Err(words::no_host(name)),
            host => host,
        };
        if self.role == Some(Role::Slave) {
            let value = self.threads.to_string();
            arguments.settings.push(Override { option: "-t", setting: "num_threads", value });
        }
        Ok(arguments)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_front::flags::parse;

    fn line(words: &[&str]) -> Arguments {
        parse(words.iter().map(Into::into)).expect("a command line")
    }

    #[test]
    fn a_command_line_comes_back() {
        for words in [
            &["a.igs"][..],
            &["-n", "m", "-p", "7000", "--key-file", "key", "a.igs"],
            &["-n", "wm", "a.igs"],
            &["-n", "s", "-h", "lust:7000", "-t", "3"],
            &["-n", "s", "-h", "[::1]:7000"],
        ] {
            let arguments = line(words);
            let part = Part::of(&arguments);
            let again = part.in_arguments(&line(&[])).expect("the same");
            assert_eq!(
                (again.network, &again.key_file, &again.host),
                (arguments.network, &arguments.key_file, &arguments.host)
            );
            assert_eq!(Part::of(&again), part, "{words:?}");
        }
    }

    #[test]
    fn a_host_must_be_one() {
        let slave = Part { host: " lust ".to_owned(), ..Part::of(&line(&["-n", "s"])) };
        assert_eq!(slave.in_arguments(&line(&[])).map(|a| a.host), Ok(Some(("lust".to_owned(), PORT))));
        assert!(Part { host: "lust:many".to_owned(), ..slave }.in_arguments(&line(&[])).is_err());
    }
}
