//! Which logs: files, folders, and a part of them for each machine.

use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result, bail};

/// The logs named, sorted by path, each once: a folder stands for every `*.mcap` in it and below, upper
/// case and links included.
///
/// # Errors
/// When a folder cannot be read, or has no log, or has something in it that could be one or lead to
/// some: nothing verified must not look like all is well.
pub fn logs(named: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let mut logs = Vec::new();
    for path in named {
        if path.is_dir() {
            let before = logs.len();
            Walk::default().all_below(path, &mut logs)?;
            if logs.len() == before {
                bail!("{}: no *.mcap in this folder", path.display());
            }
        } else {
            logs.push(path.clone());
        }
    }
    logs.sort();
    let mut seen = Vec::new();
    logs.retain(|log| {
        // The same file under two names is one log.
        let file = fs::canonicalize(log).unwrap_or_else(|_| log.clone());
        let new = !seen.contains(&file);
        seen.push(file);
        new
    });
    Ok(logs)
}

/// Folders under way.
#[derive(Default)]
struct Walk {
    /// Where it has been, links followed: a link that leads back here ends here.
    seen: BTreeSet<PathBuf>,
    /// Linked folders: looked at after all others, so that what is found does not depend on the order
    /// in which a machine lists a folder.
    linked: BTreeSet<PathBuf>,
}

impl Walk {
    fn all_below(mut self, folder: &Path, logs: &mut Vec<PathBuf>) -> Result<()> {
        self.folder(folder, logs)?;
        while let Some(folder) = self.linked.pop_first() {
            self.folder(&folder, logs)?;
        }
        Ok(())
    }

    fn folder(&mut self, folder: &Path, logs: &mut Vec<PathBuf>) -> Result<()> {
        let read = || format!("cannot read the folder {}", folder.display());
        if !self.seen.insert(fs::canonicalize(folder).with_context(read)?) {
            return Ok(());
        }
        for entry in fs::read_dir(folder).with_context(read)? {
            let entry = entry.with_context(read)?;
            let (path, kind) = (entry.path(), entry.file_type().with_context(read)?);
            let is_log = path.extension().is_some_and(|name| name.eq_ignore_ascii_case("mcap"));
            if kind.is_dir() {
                self.folder(&path, logs)?;
            } else if kind.is_symlink() && path.is_dir() {
                self.linked.insert(path);
            } else if is_log && (kind.is_symlink() || kind.is_file()) {
                // A link to nothing is told when it is read.
                logs.push(path);
            } else if is_log {
                bail!("{}: neither a file nor a folder", path.display());
            } else if kind.is_symlink() && !path.exists() {
                bail!("{}: a link to nothing; it may have led to logs", path.display());
            }
        }
        Ok(())
    }
}

/// A part of the logs: `2/3` is the second of three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    of: usize,
}

impl Shard {
    /// Its logs: every so-manieth of the sorted list. Whoever has the same list gets the same parts,
    /// and no part has more than one log more than another.
    pub fn of(self, sorted: Vec<PathBuf>) -> Vec<PathBuf> {
        sorted.into_iter().skip(self.number - 1).step_by(self.of).collect()
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse::<usize>().ok();
        text.split_once('/')
            .and_then(|(i, n)| Some(Self { number: number(i)?, of: number(n)? }))
            .filter(|shard| (1..=shard.of).contains(&shard.number))
            .ok_or_else(|| "expected I/N with 1 ≤ I ≤ N, such as 2/3".into())
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shards_together_are_the_whole_and_none_is_there_twice() {
        for count in 0..20_usize {
            let whole: Vec<PathBuf> = (0..count).map(|i| format!("{i:02}.mcap").into()).collect();
            for of in 1..9 {
                let parts: Vec<Vec<PathBuf>> =
                    (1..=of).map(|number| Shard { number, of }.of(whole.clone())).collect();
                let (least, most) = (count / of, count.div_ceil(of));
                assert!(parts.iter().all(|part| (least..=most).contains(&part.len())));
                let mut sum = parts.concat();
                sum.sort();
                assert_eq!(sum, whole, "{count} logs in {of} shards");
            }
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        assert_eq!("2/3".parse(), Ok(Shard { number: 2, of: 3 }));
        for text in ["", "1", "0/3", "4/3", "1/0", "a/b", "1/2/3", "-1/2"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
