//! Reading packed scenes, which may come from anybody.

use super::is_main;
use std::collections::HashMap;
use std::io::{Cursor, Read};
use std::sync::Arc;
use zip::ZipArchive;
use zip::result::ZipError;

/// Bounds on a packed scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackLimits {
    /// Largest number of members.
    pub members: usize,
    /// Largest size of a member in bytes.
    pub member_bytes: u64,
    /// Largest size of all members together in bytes.
    pub total_bytes: u64,
    /// How much larger than the archive its members may be together, beyond [`PackLimits::always_allowed`]: real
    /// scenes become three to twenty times as large, what is made to fill a disk a thousand times.
    pub growth: u64,
    /// What the members may have together, however small the archive is, in bytes.
    pub always_allowed: u64,
}

impl Default for PackLimits {
    /// 10,000 members of up to 4 GiB, 64 GiB together, 200 times the archive beyond the first 256 MiB.
    fn default() -> Self {
        Self {
            members: 10_000,
            member_bytes: 4 << 30,
            total_bytes: 64 << 30,
            growth: 200,
            always_allowed: 256 << 20,
        }
    }
}

/// Why a packed scene is not read.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
pub enum PackError {
    /// It is no zip archive, or a damaged one.
    #[error("this is not a sound packed scene (a zip archive): {0}")]
    Damaged(String),
    /// It is larger than it may be.
    #[error("this packed scene is refused: {0}")]
    TooLarge(String),
    /// A member that could do harm or is not a file.
    #[error("this packed scene is refused: its member {name:?} {what}")]
    Harmful {
        /// The member.
        name: String,
        /// What is wrong with it.
        what: &'static str,
    },
    /// Members that share their bytes.
    #[error("this packed scene is refused: some of its members share their bytes")]
    Overlap,
    /// No scene in it, or more than one.
    #[error("a packed scene holds one scene, a file that ends in .igs; this one holds {}", names(.0))]
    Scenes(Vec<String>),
    /// No material in it, or more than one.
    #[error("a packed material holds one material, a file that ends in .igm; this one holds {}", names(.0))]
    Materials(Vec<String>),
}

fn names(scenes: &[String]) -> String {
    if scenes.is_empty() { "none".to_owned() } else { scenes.join(", ") }
}

fn damaged(error: &ZipError) -> PackError {
    PackError::Damaged(error.to_string())
}

/// A packed scene that was looked through and found harmless; nothing but the list of its members is unpacked.
#[derive(Clone)]
pub struct Pack {
    archive: ZipArchive<Cursor<Arc<[u8]>>>,
    members: Vec<Member>,
    /// Members by their name in small letters.
    by_name: HashMap<String, usize>,
}

#[derive(Clone)]
struct Member {
    name: String,
    /// Its number in the archive.
    index: usize,
    /// Its size in bytes, as the archive says.
    size: u64,
}

impl Pack {
    /// Looks through an archive.
    ///
    /// # Errors
    /// See [`PackError`].
    pub fn open(bytes: Arc<[u8]>, limits: &PackLimits) -> Result<Self, PackError> {
        let archive_size = bytes.len() as u64;
        let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|e| damaged(&e))?;
        if archive.len() > limits.members {
            return Err(PackError::TooLarge(format!("it has {} members", archive.len())));
        }
        if archive.has_duplicate_names() {
            return Err(PackError::Damaged("two members have the same name".to_owned()));
        }
        if archive.has_overlapping_entries().map_err(|e| damaged(&e))? {
            return Err(PackError::Overlap);
        }
        let members = members(&mut archive)?;
        let mut by_name = HashMap::new();
        for (i, member) in members.iter().enumerate() {
            if by_name.insert(member.name.to_lowercase(), i).is_some() {
                let what = "has the name of another, but for capital letters and slashes";
                return Err(PackError::Harmful { name: member.name.clone(), what });
            }
        }
        let is_folder_too = |member: &&Member| {
            let name = member.name.to_lowercase();
            name.match_indices('/').any(|(end, _)| by_name.contains_key(&name[..end]))
        };
        if let Some(member) = members.iter().find(is_folder_too) {
            let what = "lies in a folder that is a file, too";
            return Err(PackError::Harmful { name: member.name.clone(), what });
        }
        check_sizes(&members, archive_size, limits)?;
        Ok(Self { archive, members, by_name })
    }

    /// Names and sizes, in bytes, of the files.
    pub fn members(&self) -> impl Iterator<Item = (&str, u64)> {
        self.members.iter().map(|m| (&*m.name, m.size))
    }

    /// The name of the scene.
    ///
    /// # Errors
    /// [`PackError::Scenes`] if there is none or more than one.
    pub fn main(&self) -> Result<&str, PackError> {
        self.only(".igs").map_err(PackError::Scenes)
    }

    /// The name of the material of a packed one.
    ///
    /// # Errors
    /// [`PackError::Materials`] if there is none or more than one.
    pub fn material(&self) -> Result<&str, PackError> {
        self.only(".igm").map_err(PackError::Materials)
    }

    /// The only file of an ending that no other names; where there is none or more than one, all there are.
    fn only(&self, ending: &str) -> Result<&str, Vec<String>> {
        let is_main = |name: &&str| is_main(name, ending);
        let mut scenes: Vec<&str> = self.members.iter().map(|m| &*m.name).filter(is_main).collect();
        match (scenes.pop(), scenes.is_empty()) {
            (Some(scene), true) => Ok(scene),
            (last, _) => Err(scenes.into_iter().chain(last).map(str::to_owned).collect()),
        }
    }

    /// The name of a member as it is written, from one that may differ in capital letters.
    pub(super) fn find(&self, name: &str) -> Option<&str> {
        let index = self.by_name.get(&name.to_lowercase())?;
        self.members.get(*index).map(|m| &*m.name)
    }

    /// The content of a member.
    ///
    /// # Errors
    /// [`PackError::Damaged`] where it is not there, or not as the archive says.
    pub fn read(&self, name: &str) -> Result<Vec<u8>, PackError> {
        let member = self.by_name.get(&name.to_lowercase()).and_then(|i| self.members.get(*i));
        let Some(member) = member else { return Err(PackError::Damaged(format!("there is no {name:?}"))) };
        // Clones share the bytes: members can be read side by side.
        let mut archive = self.archive.clone();
        let file = archive.by_index(member.index).map_err(|e| damaged(&e))?;
        let mut content = vec![];
        // What the archive says of the size is not trusted with memory before the bytes are there.
        let read = file.take(member.size + 1).read_to_end(&mut content);
        match read {
            Ok(_) if content.len() as u64 == member.size => Ok(content),
            Ok(_) => Err(PackError::Damaged(format!("{name:?} is not as long as it should be"))),
            Err(error) => Err(PackError::Damaged(format!("{name:?}: {error}"))),
        }
    }
}

fn members(archive: &mut ZipArchive<Cursor<Arc<[u8]>>>) -> Result<Vec<Member>, PackError> {
    let mut members = vec![];
    for index in 0..archive.len() {
        let file = archive.by_index_raw(index).map_err(|e| damaged(&e))?;
        // Programs of Windows have written `\\` between folders, which the format does not allow (APPNOTE 4.4.17.1).
        let name = file.name().map_err(|e| damaged(&e))?.replace('\\', "/");
        if let Some(what) = harm(&name) {
            return Err(PackError::Harmful { name, what });
        }
        if name.ends_with('/') {
            continue;
        }
        let what = match file.unix_mode().map(|mode| mode & FILE_KIND) {
            None | Some(0 | REGULAR_FILE) if !file.encrypted() => {
                members.push(Member { name, index, size: file.size() });
                continue;
            }
            None | Some(0 | REGULAR_FILE) => "is encrypted",
            Some(_) => "is a link or a device",
        };
        return Err(PackError::Harmful { name, what });
    }
    Ok(members)
}

/// The bits of a file's mode that tell its kind, and what they are for a file (POSIX `S_IFMT`, `S_IFREG`).
const FILE_KIND: u32 = 0o170_000;
const REGULAR_FILE: u32 = 0o100_000;

/// What is wrong with a name, if it could lead out of the archive's folder or is none on some system.
pub(super) fn harm(name: &str) -> Option<&'static str> {
    let path = name.strip_suffix('/').unwrap_or(name);
    if path.starts_with('/') || path.contains(['\\', ':']) {
        Some("has a path that is not within the archive")
    } else if path.split('/').any(|part| part == ".." || part == ".") {
        Some("has a path that leads out of the archive")
    } else if path.split('/').any(is_impossible) || path.len() > LONGEST_PATH {
        Some("has a name that not every system allows")
    } else {
        None
    }
}

/// The most bytes of a file's name: what the file systems of Linux take, and nearly what those of others do.
const LONGEST_NAME: usize = 255;
/// The same of a path within the archive: half of what macOS takes, as there is a folder before it.
const LONGEST_PATH: usize = 512;

/// Whether a file cannot be called so on some system, or means a device there.
fn is_impossible(name: &str) -> bool {
    const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_ascii_lowercase();
    let is_port = |port: &str| {
        stem.strip_prefix(port).is_some_and(|n| n.len() == 1 && n.bytes().all(|b| b.is_ascii_digit()))
    };
    name.is_empty()
        || name.len() > LONGEST_NAME
        || name.ends_with(['.', ' '])
        || name.chars().any(|c| c.is_control() || "<>\"|?*".contains(c))
        || DEVICES.contains(&&*stem)
        || is_port("com")
        || is_port("lpt")
}

fn check_sizes(members: &[Member], archive: u64, limits: &PackLimits) -> Result<(), PackError> {
    if let Some(member) = members.iter().find(|m| m.size > limits.member_bytes) {
        let what =
            format!("{:?} has {} bytes, a file may have {}", member.name, member.size, limits.member_bytes);
        return Err(PackError::TooLarge(what));
    }
    // The sizes are small enough that their sum, of at most so many members, is far from overflow.
    let total = members.iter().map(|m| m.size).fold(0, u64::saturating_add);
    let most = archive.saturating_mul(limits.growth).max(limits.always_allowed).min(limits.total_bytes);
    if total > most {
        let what = format!("of {archive} bytes it would become {total}; it may become {most}");
        return Err(PackError::TooLarge(what));
    }
    Ok(())
}
