//! The house: crates use only the floors below, no two files or rooms import each other, files are short enough to hold
//! in mind, and no crate outgrows the others.
#![allow(clippy::unwrap_used, reason = "what only tests call")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use syn::visit::Visit;

/// Crates from the ground floor up: each may use those before it.
const FLOORS: [&str; 13] = [
    "grn-core",
    "grn-input",
    "grn-optimisers",
    "grn-figures",
    "grn-link",
    "firmware-sim",
    "host-evolver",
    "grn-python",
    "grn-trials",
    "grn-firmware",
    "grn-c",
    "grn-tests",
    "xtask",
];
/// More lines than this are too many to hold in mind.
const MOST_LINES: usize = 400;
/// The largest share of the lines that one crate may have.
const LARGEST_SHARE: f64 = 0.35;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Name, folder and manifest of every crate of the workspace and of the firmware's.
fn crates() -> Vec<(String, PathBuf, toml::Table)> {
    let folders =
        ["grn-core", "firmware-sim", "host-evolver", "python", "tests", "xtask"].map(|name| root().join(name));
    let nested = ["crates", "firmware"].into_iter().flat_map(|name| {
        let entries = fs::read_dir(root().join(name)).unwrap();
        entries.map(|entry| entry.unwrap().path()).filter(|path| path.join("Cargo.toml").exists())
    });
    let read = |folder: PathBuf| {
        let manifest: toml::Table = fs::read_to_string(folder.join("Cargo.toml")).unwrap().parse().unwrap();
        (manifest["package"]["name"].as_str().unwrap().to_owned(), folder, manifest)
    };
    folders.into_iter().chain(nested).map(read).collect()
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let Ok(entries) = fs::read_dir(folder) else { return files };
    for path in entries.map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            if !path.ends_with("target") {
                files.extend(rust_files(&path));
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

#[test]
fn crates_use_only_the_floors_below_them() {
    for (name, _, manifest) in crates() {
        let floor = FLOORS.iter().position(|known| *known == name);
        let floor = floor.unwrap_or_else(|| panic!("{name} has no floor yet: give it one in this test"));
        let dependencies = manifest.get("dependencies").and_then(toml::Value::as_table).cloned().unwrap_or_default();
        for dependency in dependencies.keys() {
            if let Some(below) = FLOORS.iter().position(|known| known == dependency) {
                assert!(below < floor, "{name} uses {dependency}, which is on the same floor or above");
            }
        }
    }
}

/// The paths that a file names, as `crate::a::b`; modules of tests are left out.
struct Paths {
    module: Vec<String>,
    found: BTreeSet<Vec<String>>,
}

impl Paths {
    fn absolute(&self, path: &[String]) -> Option<Vec<String>> {
        match path.first()?.as_str() {
            "crate" => Some(path[1..].to_vec()),
            "self" => Some([&self.module, &path[1..]].concat()),
            "super" => {
                let above = path.iter().take_while(|segment| *segment == "super").count();
                let kept = self.module.len().checked_sub(above)?;
                Some([&self.module[..kept], &path[above..]].concat())
            }
            _ => None,
        }
    }

    fn add(&mut self, path: &[String]) {
        self.found.extend(self.absolute(path));
    }

    fn add_tree(&mut self, tree: &syn::UseTree, before: &[String]) {
        match tree {
            syn::UseTree::Path(path) => self.add_tree(&path.tree, &[before, &[path.ident.to_string()]].concat()),
            syn::UseTree::Name(name) => self.add(&[before, &[name.ident.to_string()]].concat()),
            syn::UseTree::Rename(name) => self.add(&[before, &[name.ident.to_string()]].concat()),
            syn::UseTree::Glob(_) => self.add(before),
            syn::UseTree::Group(group) => group.items.iter().for_each(|tree| self.add_tree(tree, before)),
        }
    }
}

fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    let is_test = |attribute: &syn::Attribute| {
        attribute.path().is_ident("cfg")
            && attribute.meta.require_list().is_ok_and(|list| list.tokens.to_string() == "test")
    };
    attributes.iter().any(is_test)
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        if !is_for_tests(&module.attrs) {
            syn::visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if !is_for_tests(&item.attrs) {
            self.add_tree(&item.tree, &[]);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.add(&path.segments.iter().map(|segment| segment.ident.to_string()).collect::<Vec<_>>());
        syn::visit::visit_path(self, path);
    }
}

/// The module that a file is: `src/a/b.rs` and `src/a/b/mod.rs` are `[a, b]`.
fn module_of(source: &Path, file: &Path) -> Vec<String> {
    let path = file.strip_prefix(source).unwrap().with_extension("");
    let mut module: Vec<String> = path.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if matches!(module.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        module.pop();
    }
    module
}

/// For each module of a crate the modules it imports.
fn imports(source: &Path) -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
    let is_code = |file: &PathBuf| {
        let name = file.file_name().unwrap();
        name != "tests.rs" && name != "main.rs" && file.parent().is_none_or(|folder| !folder.ends_with("bin"))
    };
    let files: Vec<PathBuf> = rust_files(source).into_iter().filter(is_code).collect();
    let modules: BTreeSet<Vec<String>> = files.iter().map(|file| module_of(source, file)).collect();
    let mut imports = BTreeMap::new();
    for file in &files {
        let module = module_of(source, file);
        let mut paths = Paths { module: module.clone(), found: BTreeSet::new() };
        paths.visit_file(&syn::parse_file(&fs::read_to_string(file).unwrap()).unwrap());
        let module_named = |path: &Vec<String>| {
            let longest = (0..=path.len()).rev().map(|length| path[..length].to_vec());
            longest.into_iter().find(|module| modules.contains(module))
        };
        let named = paths.found.iter().filter_map(module_named).filter(|named| *named != module);
        imports.insert(module.clone(), named.collect());
    }
    imports
}

/// A circle of imports, if there is one.
fn circle<N: Ord + Clone>(graph: &BTreeMap<N, BTreeSet<N>>) -> Option<Vec<N>> {
    fn visit<N: Ord + Clone>(
        node: &N,
        graph: &BTreeMap<N, BTreeSet<N>>,
        path: &mut Vec<N>,
        done: &mut BTreeSet<N>,
    ) -> Option<Vec<N>> {
        if let Some(start) = path.iter().position(|earlier| earlier == node) {
            return Some(path[start..].to_vec());
        }
        if !done.insert(node.clone()) {
            return None;
        }
        path.push(node.clone());
        let found = graph.get(node).into_iter().flatten().find_map(|next| visit(next, graph, path, done));
        path.pop();
        found
    }
    // A node that is done leads to no circle, as its whole subtree was followed with its path.
    let mut done = BTreeSet::new();
    graph.keys().find_map(|node| visit(node, graph, &mut Vec::new(), &mut done))
}

#[test]
fn no_two_files_import_each_other() {
    for (name, folder, _) in crates() {
        if let Some(circle) = circle(&imports(&folder.join("src"))) {
            let files: Vec<String> = circle.iter().map(|module| format!("crate::{}", module.join("::"))).collect();
            panic!("{name}: {} import each other", files.join(" -> "));
        }
    }
}

#[test]
fn no_two_rooms_import_each_other() {
    for (name, folder, _) in crates() {
        let mut rooms: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (module, named) in imports(&folder.join("src")) {
            let Some(room) = module.first() else { continue };
            let others = named.iter().filter_map(|other| other.first()).filter(|other| *other != room);
            rooms.entry(room.clone()).or_default().extend(others.cloned());
        }
        if let Some(circle) = circle(&rooms) {
            panic!("{name}: the rooms {} import each other", circle.join(" -> "));
        }
    }
}

#[test]
fn circles_are_found() {
    let graph = |edges: &[(u8, u8)]| {
        let mut graph: BTreeMap<u8, BTreeSet<u8>> = BTreeMap::new();
        for &(from, to) in edges {
            graph.entry(from).or_default().insert(to);
        }
        graph
    };
    assert_eq!(circle(&graph(&[(1, 2), (2, 3), (1, 3)])), None);
    assert_eq!(circle(&graph(&[(1, 2), (2, 3), (3, 2)])), Some(vec![2, 3]));
    let source = "use super::{b::C, d}; use crate::e::*; mod tests_of_it { } #[cfg(test)] mod tests { use crate::f; }";
    let mut paths = Paths { module: vec!["x".into(), "a".into()], found: BTreeSet::new() };
    paths.visit_file(&syn::parse_file(source).unwrap());
    let found: Vec<String> = paths.found.iter().map(|path| path.join("::")).collect();
    assert_eq!(found, ["e", "x::b::C", "x::d"]);
}

#[test]
fn files_are_short_enough_to_hold_in_mind() {
    let long = crates().into_iter().flat_map(|(_, folder, _)| rust_files(&folder)).filter_map(|file| {
        let lines = fs::read_to_string(&file).unwrap().lines().count();
        (lines > MOST_LINES).then(|| format!("{} has {lines} lines", file.display()))
    });
    let long: Vec<String> = long.collect();
    assert!(long.is_empty(), "more than {MOST_LINES} lines:\n{}", long.join("\n"));
}

#[test]
fn no_crate_outgrows_the_others() {
    let lines = |folder: &Path| -> usize {
        rust_files(folder).iter().map(|file| fs::read_to_string(file).unwrap().lines().count()).sum()
    };
    let sizes: Vec<(String, usize)> = crates().into_iter().map(|(name, folder, _)| (name, lines(&folder))).collect();
    let all: usize = sizes.iter().map(|(_, lines)| lines).sum();
    for (name, lines) in sizes {
        let share = lines as f64 / all as f64;
        assert!(share < LARGEST_SHARE, "{name} holds {:.0} % of the lines", 100.0 * share);
    }
}
