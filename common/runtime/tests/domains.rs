//! What a domain leaves behind, and what is no domain.
#![allow(clippy::unwrap_used)]

use messages::{ImuSample, topic};
use runtime::{Domain, Node, Publisher, Subscriber};
use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};

/// Opens ports, so that there is something to remove, and leaves them open as a killed process does.
fn fill(domain: &Domain) {
    let node = Node::open(domain, "node").unwrap();
    let reader = Subscriber::open(&node, &topic::main_imu()).unwrap();
    let writer = Publisher::open(&node, &topic::main_imu()).unwrap();
    writer.publish(&ImuSample::default()).unwrap();
    reader.take().unwrap();
    std::mem::forget((node, reader, writer));
}

#[test]
fn remove_leaves_nothing() {
    let domain = Domain::create().unwrap();
    fill(&domain);
    let names: Vec<String> = domain.leftovers().iter().map(|path| path.display().to_string()).collect();
    assert!(names.iter().any(|name| name.ends_with(".global_mgmt")), "{names:?}");
    assert!(names.iter().any(|name| name.ends_with(".data")), "{names:?}");
    domain.remove().unwrap();
    assert_eq!(domain.leftovers(), Vec::<PathBuf>::new());
    assert!(!domain.root().exists());
    domain.remove().unwrap();
}

#[test]
fn a_domain_removes_itself_unless_told_otherwise() {
    let domain = Domain::create().unwrap();
    let root = domain.root().to_owned();
    drop(Domain::open(&root).unwrap());
    assert!(root.exists(), "only its maker removes it");
    drop(domain);
    assert!(!root.exists());

    let mut kept = Domain::create().unwrap();
    kept.keep();
    let root = kept.root().to_owned();
    drop(kept);
    let again = Domain::open(&root).unwrap();
    again.remove().unwrap();
    assert!(!root.exists());
}

#[test]
fn a_domain_is_private_and_its_path_short() {
    let (one, two) = (Domain::create().unwrap(), Domain::create().unwrap());
    assert_ne!(one.root(), two.root());
    assert_ne!(one.prefix(), two.prefix());
    for path in [one.root(), one.root().parent().unwrap()] {
        assert_eq!(fs::metadata(path).unwrap().mode() & 0o777, 0o700, "{}", path.display());
    }
    assert!(one.root().as_os_str().len() <= 50);
    assert_eq!(Domain::open(one.root()).unwrap().prefix(), one.prefix());
}

#[test]
fn what_is_no_domain_is_refused() {
    let folder = std::env::temp_dir().join(format!("deckflex-runtime-{}", std::process::id()));
    let unowned = folder.join("df01234567");
    fs::create_dir_all(&unowned).unwrap();
    let garbled = folder.join("df89abcdef");
    fs::create_dir_all(&garbled).unwrap();
    fs::write(garbled.join("owner"), "nobody").unwrap();
    let long = folder.join("x".repeat(60)).join("df01234567");
    fs::create_dir_all(&long).unwrap();
    for (path, reason) in [
        (folder.as_path(), "name"),
        (Path::new("/nowhere/df01234567"), "no such directory"),
        (&unowned, "no owner"),
        (&garbled, "no owner"),
        (&long, "too long"),
    ] {
        let error = Domain::open(path).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o700)).unwrap();
    fs::remove_dir_all(&folder).unwrap();
}
