use crate::TransportError;
use crate::mender::Mender;
use crate::owner::Owner;
use iceoryx2::config::Config;
use iceoryx2::prelude::{FileName, SemanticString};
use std::fs::{self, DirBuilder};
use std::hash::{BuildHasher, Hasher};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::path::{Path, PathBuf};
use std::time::Duration;

const SHARED_MEMORY: &str = "/dev/shm";
const OWNER_FILE: &str = "owner";
/// A socket's path has room for 107 bytes; the transport adds a slash, the prefix of 11, a number of up to 39 and a suffix of 6.
const LONGEST_ROOT: usize = 107 - 1 - 11 - 39 - 6;
/// A directory without an owner file is either abandoned or just being made; after this time it is abandoned.
const GRACE: Duration = Duration::from_secs(60);

/// A transport of its own for each launch: what two launches do never meets, and what one leaves behind can be found and removed.
///
/// Its files lie in `root` and, beginning with `prefix`, in `/dev/shm`. A domain made with [`Domain::create`] removes itself when
/// it is dropped, so it must outlive the nodes opened in it; while it lives, a thread mends what killed processes leave half made.
#[derive(Debug)]
pub struct Domain {
    root: PathBuf,
    prefix: String,
    owned: bool,
    /// Of the domain's maker.
    _mender: Option<Mender>,
}

/// A domain in use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Running {
    /// Its root.
    pub root: PathBuf,
    /// The launcher's process.
    pub pid: u32,
}

impl Domain {
    /// Makes a new domain that belongs to this process.
    ///
    /// It lies in `$XDG_RUNTIME_DIR/deckflex-<uid>/`, or in `/tmp/deckflex-<uid>/` where that does not exist, cannot be written or is
    /// too long for the names of sockets.
    ///
    /// # Errors
    /// If the directory cannot be made, or belongs to somebody else.
    pub fn create() -> Result<Self, TransportError> {
        let base = base()?;
        let owner = Owner::this_process().ok_or_else(|| TransportError::System {
            call: "reading the start time of this process",
            source: io::ErrorKind::NotFound.into(),
        })?;
        loop {
            let name = format!("df{:08x}", std::hash::RandomState::new().build_hasher().finish() as u32);
            let root = base.join(&name);
            match DirBuilder::new().mode(0o700).create(&root) {
                Ok(()) => {
                    let mut domain = Self::at(root, &name);
                    domain.owned = true;
                    let file = domain.root.join(OWNER_FILE);
                    fs::write(&file, owner.to_text()).map_err(TransportError::file("write", &file))?;
                    domain._mender = Some(Mender::start(domain.prefix.clone())?);
                    return Ok(domain);
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(TransportError::file("make", &root)(error)),
            }
        }
    }

    fn at(root: PathBuf, name: &str) -> Self {
        Self { root, prefix: format!("{name}_"), owned: false, _mender: None }
    }

    /// Opens the domain of a living launcher, as a stage does.
    ///
    /// # Errors
    /// If `root` is no domain, or if its owner does not run any more.
    pub fn open(root: &Path) -> Result<Self, TransportError> {
        let refuse = |reason| TransportError::NotADomain { path: root.to_owned(), reason };
        let root = root.canonicalize().map_err(|_| refuse("there is no such directory"))?;
        let name = name_of(&root).ok_or_else(|| refuse("its name is not that of a domain"))?;
        if root.as_os_str().len() > LONGEST_ROOT {
            return Err(refuse("its path is too long for the names of sockets"));
        }
        match owner_of(&root) {
            Some(owner) if owner.lives() => Ok(Self::at(root.clone(), name)),
            Some(_) => Err(refuse("its owner does not run any more")),
            None => Err(refuse("it has no owner")),
        }
    }

    /// The directory, which is what a launcher tells its stages.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// What the names of all its files in shared memory begin with.
    pub fn prefix(&self) -> &str {
        &self.prefix
    }

    /// The transport's configuration: root and prefix are set here and no configuration file is looked for.
    ///
    /// # Errors
    /// If the transport refuses the path.
    pub fn config(&self) -> Result<Config, TransportError> {
        let refuse = |_| TransportError::NotADomain {
            path: self.root.clone(),
            reason: "the transport refuses characters of its path",
        };
        let mut config = Config::default();
        let root = iceoryx2::prelude::Path::new(self.root.as_os_str().as_bytes()).map_err(refuse)?;
        config.global.set_root_path(&root);
        config.global.prefix = FileName::new(self.prefix.as_bytes()).map_err(refuse)?;
        Ok(config)
    }

    /// Leaves the domain in place when this value is dropped.
    pub fn keep(&mut self) {
        self.owned = false;
    }

    /// Deletes every file of the domain. What is deleted already is no error.
    ///
    /// # Errors
    /// The first file that could not be removed; the others are removed all the same.
    pub fn remove(&self) -> Result<(), TransportError> {
        let mut first = Ok(());
        for file in shared_memory(&self.prefix) {
            first = first.and(tolerate(fs::remove_file(&file)).map_err(TransportError::file("remove", &file)));
        }
        // Last, for without it a sweep would not find the rest.
        first.and(tolerate(fs::remove_dir_all(&self.root)).map_err(TransportError::file("remove", &self.root)))
    }

    /// What still exists of the domain: its root and its files in shared memory.
    pub fn leftovers(&self) -> Vec<PathBuf> {
        let mut paths = shared_memory(&self.prefix);
        if self.root.exists() {
            paths.push(self.root.clone());
        }
        paths
    }

    /// Removes the domains whose owner does not run any more, and gives their roots.
    ///
    /// # Errors
    /// If the folder of domains cannot be read, or the first domain that cannot be removed, as when stages of a dead launcher are just
    /// leaving it; the others are removed all the same.
    pub fn sweep() -> Result<Vec<PathBuf>, TransportError> {
        let base = base()?;
        let (mut removed, mut first) = (Vec::new(), Ok(()));
        for entry in fs::read_dir(&base).map_err(TransportError::file("read", &base))?.flatten() {
            let root = entry.path();
            let Some(name) = name_of(&root).filter(|_| is_abandoned(&root)) else { continue };
            match Self::at(root.clone(), name).remove() {
                Ok(()) => removed.push(root),
                Err(error) => first = first.and(Err(error)),
            }
        }
        first.map(|()| removed)
    }

    /// The domains of this user whose launchers run now.
    ///
    /// # Errors
    /// If the folder of domains cannot be read.
    pub fn running() -> Result<Vec<Running>, TransportError> {
        let base = base()?;
        let entries = fs::read_dir(&base).map_err(TransportError::file("read", &base))?.flatten();
        let running = |root: PathBuf| {
            name_of(&root)?;
            let owner = owner_of(&root).filter(|owner| owner.lives())?;
            Some(Running { root, pid: owner.pid })
        };
        Ok(entries.filter_map(|entry| running(entry.path())).collect())
    }
}

impl Drop for Domain {
    fn drop(&mut self) {
        if self.owned {
            // What cannot be removed now is found by the next sweep.
            let _ = self.remove();
        }
    }
}

/// The files in shared memory whose names begin with the prefix.
pub(crate) fn shared_memory(prefix: &str) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(SHARED_MEMORY) else { return Vec::new() };
    let ours = |path: &PathBuf| path.file_name().is_some_and(|name| name.as_bytes().starts_with(prefix.as_bytes()));
    entries.flatten().map(|entry| entry.path()).filter(ours).collect()
}

/// `df` and eight hexadecimal digits: nothing else may ever become a prefix of files to be deleted.
fn name_of(root: &Path) -> Option<&str> {
    let name = root.file_name()?.to_str()?;
    let digits = name.strip_prefix("df")?;
    let valid = digits.len() == 8 && digits.bytes().all(|c| c.is_ascii_digit() || (b'a'..=b'f').contains(&c));
    valid.then_some(name)
}

fn owner_of(root: &Path) -> Option<Owner> {
    Owner::from_text(&fs::read_to_string(root.join(OWNER_FILE)).ok()?)
}

fn is_abandoned(root: &Path) -> bool {
    match owner_of(root) {
        Some(owner) => !owner.lives(),
        None => {
            let modified = fs::symlink_metadata(root).and_then(|data| data.modified());
            modified.is_ok_and(|time| time.elapsed().is_ok_and(|age| age > GRACE))
        }
    }
}

fn tolerate(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

/// The folder of this user's domains, made where it does not exist.
fn base() -> Result<PathBuf, TransportError> {
    // SAFETY: the call has no preconditions and cannot fail.
    let uid = unsafe { libc::geteuid() };
    let name = format!("deckflex-{uid}");
    if let Some(runtime) = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from) {
        let folder = runtime.join(&name);
        let fits = runtime.is_absolute() && folder.as_os_str().len() + "/df01234567".len() <= LONGEST_ROOT;
        if fits && runtime.is_dir() && private_folder(&folder, uid).is_ok() {
            return Ok(folder);
        }
    }
    let folder = Path::new("/tmp").join(&name);
    private_folder(&folder, uid).map_err(TransportError::file("use", &folder))?;
    Ok(folder)
}

/// Anybody may write in `/tmp`, so a folder there is trusted only if it is ours and closed to others.
fn private_folder(folder: &Path, uid: u32) -> io::Result<()> {
    match DirBuilder::new().mode(0o700).create(folder) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
        _ => {}
    }
    let data = fs::symlink_metadata(folder)?;
    if !data.is_dir() || data.uid() != uid || data.mode() & 0o077 != 0 {
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, "it must be a directory of ours with mode 0700"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_domains_are_accepted() {
        assert_eq!(name_of(Path::new("/tmp/x/df0123abcd")), Some("df0123abcd"));
        for bad in ["/tmp/x/df", "/tmp/x/df0123ABCD", "/tmp/x/df0123abcde", "/tmp/x/iox2_12345", "/", "/tmp/df0123abc*"]
        {
            assert_eq!(name_of(Path::new(bad)), None, "{bad}");
        }
    }
}
