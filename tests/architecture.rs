//! Who may import whom, and what may stand at the top of the repository: the rules of the design, kept by a test.
#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates of the workspace and, of each, what its code (not its tests) imports directly.
struct Workspace {
    /// By name, with the folder.
    crates: BTreeMap<String, (PathBuf, BTreeSet<String>)>,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn cargo(arguments: &[&str]) -> String {
    let mut cargo = Command::new(env!("CARGO"));
    let output = cargo.args(arguments).arg("--offline").current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

impl Workspace {
    fn read() -> Self {
        let metadata = cargo(&["metadata", "--format-version", "1", "--no-deps"]);
        let metadata: Value = serde_json::from_str(&metadata).unwrap();
        let mut crates = BTreeMap::new();
        for package in metadata["packages"].as_array().unwrap() {
            let folder = Path::new(package["manifest_path"].as_str().unwrap()).parent().unwrap().to_owned();
            let dependencies = package["dependencies"].as_array().unwrap().iter();
            let imports = dependencies.filter(|d| d["kind"] != "dev").map(|d| d["name"].as_str().unwrap().to_owned());
            crates.insert(package["name"].as_str().unwrap().to_owned(), (folder, imports.collect()));
        }
        Self { crates }
    }

    /// What a crate imports directly.
    fn imports(&self, name: &str) -> &BTreeSet<String> {
        &self.crates.get(name).unwrap_or_else(|| panic!("there is no crate {name}")).1
    }

    /// What a crate imports directly of this workspace.
    fn own_imports(&self, name: &str) -> BTreeSet<&str> {
        self.imports(name).iter().map(String::as_str).filter(|import| self.crates.contains_key(*import)).collect()
    }

    /// Names of the crates in a folder of the workspace.
    fn within(&self, folder: &str) -> BTreeSet<&str> {
        let inside = self.crates.iter().filter(|(_, (path, _))| path.parent() == Some(&root().join(folder)));
        inside.map(|(name, _)| name.as_str()).collect()
    }

    /// The crates that import another one directly.
    fn importers(&self, of: &str) -> Vec<&str> {
        self.crates.iter().filter(|(_, (_, imports))| imports.contains(of)).map(|(name, _)| name.as_str()).collect()
    }
}

/// Everything that a crate's code is linked with, itself included.
fn tree(name: &str) -> BTreeSet<String> {
    let tree = cargo(&["tree", "--edges", "normal,build", "--prefix", "none", "--format", "{p}", "--package", name]);
    tree.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect()
}

#[test]
fn the_layers_import_downwards_only() {
    let workspace = Workspace::read();
    let allowed: [(&str, &[&str]); 10] = [
        ("deckflex-frames", &[]),
        ("deckflex-messages", &["deckflex-frames"]),
        ("deckflex-estimation", &["deckflex-frames", "deckflex-messages"]),
        ("deckflex-simulation", &["deckflex-frames", "deckflex-messages"]),
        ("deckflex-recording", &["deckflex-messages"]),
        (
            "deckflex-pipeline",
            &[
                "deckflex-frames",
                "deckflex-messages",
                "deckflex-estimation",
                "deckflex-simulation",
                "deckflex-recording",
                "deckflex-telegrams",
                "deckflex-wire",
            ],
        ),
        ("deckflex-telegrams", &["deckflex-frames", "deckflex-messages"]),
        ("deckflex-wire", &["deckflex-frames", "deckflex-messages"]),
        ("deckflex-runtime", &["deckflex-frames", "deckflex-messages", "deckflex-wire"]),
        (
            "deckflex-experiments",
            &[
                "deckflex-frames",
                "deckflex-messages",
                "deckflex-estimation",
                "deckflex-simulation",
                "deckflex-pipeline",
            ],
        ),
    ];
    let known: BTreeSet<&str> = allowed.iter().map(|(name, _)| *name).collect();
    assert_eq!(workspace.within("common"), known, "a new crate needs its rule here");
    for (name, allowed) in allowed {
        for import in workspace.own_imports(name) {
            assert!(allowed.contains(&import), "{name} must not import {import}");
        }
    }
}

/// By the whole tree, so that nothing comes in through a third crate either.
#[test]
fn what_must_not_meet_does_not_meet() {
    // swarms and networks draw from seeds that they are told, and nothing draws from the system
    let shell = ["iceoryx2", "clap", "libc", "signal-hook", "crossbeam", "deckflex-runtime", "deckflex-pipeline"];
    let forbidden: [(&str, &[&str]); 7] = [
        ("deckflex-estimation", &[&shell[..], &["deckflex-simulation", "getrandom"]].concat()),
        ("deckflex-simulation", &[&shell[..], &["deckflex-estimation"]].concat()),
        ("deckflex-wire", &[&shell[..], &["deckflex-simulation", "deckflex-estimation"]].concat()),
        ("deckflex-pipeline", &["iceoryx2", "clap", "signal-hook", "crossbeam", "deckflex-runtime"]),
        (
            "deckflex-recording",
            &["iceoryx2", "clap", "signal-hook", "crossbeam", "deckflex-runtime", "deckflex-pipeline"],
        ),
        ("deckflex-runtime", &["clap", "deckflex-pipeline", "deckflex-estimation", "deckflex-simulation"]),
        ("deckflex-experiments", &["iceoryx2", "clap", "signal-hook", "deckflex-runtime", "plotters", "maud"]),
    ];
    for (name, forbidden) in forbidden {
        let tree = tree(name);
        assert!(tree.contains(name), "the tree is not that of {name}");
        for import in forbidden {
            assert!(
                !tree.contains(*import),
                "{import} is in the tree of {name}: see `cargo tree -i {import} -p {name}`"
            );
        }
    }
}

#[test]
fn services_do_not_import_each_other_and_nothing_below_imports_them() {
    let workspace = Workspace::read();
    let services = workspace.within("services");
    assert!(services.contains("deckflex-launch") && services.contains("deckflex-estimate"), "{services:?}");
    for name in services.iter().chain(&workspace.within("common")) {
        let met: Vec<_> = workspace.own_imports(name).intersection(&services).copied().collect();
        assert!(met.is_empty(), "{name} must not import {met:?}");
    }
}

#[test]
fn the_transport_and_the_command_line_stand_in_one_place_each() {
    let workspace = Workspace::read();
    assert_eq!(workspace.importers("iceoryx2"), ["deckflex-runtime"]);
    assert_eq!(workspace.importers("clap"), ["deckflex"]);
    // by import and not by tree: recordings are read by a library that counts processors
    let of_common = workspace.within("common");
    let of_common = |import: &str| -> Vec<&str> {
        workspace.importers(import).into_iter().filter(|name| of_common.contains(name)).collect()
    };
    assert_eq!(of_common("libc"), ["deckflex-runtime"]);
    // whoever speaks in `common` is the shell, and it alone knows where what is said goes
    assert_eq!(of_common("tracing"), ["deckflex-runtime"]);
    assert_eq!(of_common("log"), [""; 0]);
    assert!(workspace.importers("tracing").len() > 3, "the stages speak too");
}

/// No stage of a live run is linked with what draws and tabulates.
#[test]
fn the_experiments_stand_apart_from_the_stages() {
    let workspace = Workspace::read();
    assert_eq!(workspace.importers("deckflex-experiments"), ["deckflex-reproduce"]);
    assert_eq!(workspace.importers("rayon"), ["deckflex-experiments", "deckflex-reproduce"]);
    assert_eq!(workspace.importers("plotters"), ["deckflex-allan", "deckflex-bound", "deckflex-reproduce"]);
    assert_eq!(workspace.importers("maud"), ["deckflex-report", "deckflex-reproduce"]);
    assert_eq!(workspace.importers("comfy-table"), ["deckflex-reproduce"]);
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path()) {
        if entry.is_dir() {
            files.extend(sources(&entry));
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            files.push(entry);
        }
    }
    files
}

/// Comments may speak of clocks; code may not read them. `Duration` is a mere number.
#[test]
fn only_the_shell_has_clocks_threads_and_a_voice() {
    let mut lines = 0;
    for name in
        ["frames", "messages", "estimation", "simulation", "recording", "wire", "telegrams", "pipeline", "experiments"]
    {
        for file in sources(&root().join("common").join(name).join("src")) {
            for (number, line) in fs::read_to_string(&file).unwrap().lines().enumerate() {
                let code = line.split("//").next().unwrap();
                let words: Vec<&str> = code.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
                let shell =
                    ["Instant", "SystemTime", "thread", "sleep", "libc", "tracing", "println", "eprintln", "dbg"];
                let found = words.iter().find(|word| shell.contains(word));
                assert_eq!(found, None, "{}:{}: {line}", file.display(), number + 1);
                lines += 1;
            }
        }
    }
    assert!(lines > 1000, "only {lines} lines were looked at");
}

#[test]
fn the_top_of_the_repository_is_fixed() {
    let Ok(output) = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output() else { return };
    // no checkout, or one of another repository around a plain copy
    let paths = String::from_utf8(output.stdout).unwrap();
    let top: BTreeSet<&str> =
        paths.split('\0').filter_map(|path| path.split('/').next()).filter(|t| !t.is_empty()).collect();
    if !output.status.success() || !top.contains("Cargo.toml") {
        return;
    }
    let fixed = ["Cargo.toml", "Cargo.lock", "services", "common", "config", "tests", "benches", "README.md"];
    for name in top {
        let upper = |name: &str| name.chars().all(|c| c.is_ascii_uppercase() || "-_.0123456789".contains(c));
        let text = upper(name.trim_end_matches(".md"));
        assert!(fixed.contains(&name) || name.starts_with('.') || text, "{name} has no place at the top");
    }
}
