//! The files of a crate, and which of them needs which: read off the source, without a compiler.
//!
//! What a file names by `use`, by `crate::`, `super::`, `self::`, by the name of a child module or of
//! something imported is followed to the file that defines it, through re-exports. Tests modules do not
//! count. A file that only re-exports what its children define does not need them.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A path of modules below the crate's root, which is empty.
pub type Module = Vec<String>;

/// The files of a crate by module, and for each those that it needs.
#[derive(Debug, Default)]
pub struct Graph {
    pub needs: BTreeMap<Module, BTreeSet<Module>>,
    /// Names that its files bring into their scope, and what they stand for.
    aliases: BTreeMap<(Module, String), Vec<String>>,
    files: BTreeMap<Module, Source>,
}

/// A file.
#[derive(Debug)]
struct Source {
    tokens: Vec<String>,
    /// Modules that it declares in files of their own.
    children: BTreeSet<String>,
    /// Uses of names: the module in which they stand, the path, and the name it is given if it is imported.
    paths: Vec<(Module, Vec<String>, Option<Import>)>,
}

#[derive(Clone, Debug)]
struct Import {
    name: String,
    public: bool,
}

impl Graph {
    /// The crate that begins with this file.
    pub fn of(root: &Path) -> Self {
        let folder = root.parent().expect("a folder").to_path_buf();
        let mut graph = Self::default();
        graph.read(root, &folder, Vec::new());
        graph.link();
        graph
    }

    /// The public functions of a file; methods are none of them.
    pub fn functions(&self, module: &Module) -> Vec<&str> {
        let tokens = &self.files[module].tokens;
        let mut depth = 0;
        let free = tokens.windows(3).filter_map(|w| {
            match w[0].as_str() {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ => {}
            }
            (depth == 0 && w[0] == "pub" && w[1] == "fn").then_some(w[2].as_str())
        });
        free.collect()
    }

    /// Every knot of files that need each other in a circle.
    pub fn knots(&self) -> Vec<BTreeSet<Module>> {
        let reach: BTreeMap<_, _> =
            self.needs.keys().map(|from| (from, self.reached(from))).collect();
        let mut knots: Vec<BTreeSet<Module>> = Vec::new();
        for from in self.needs.keys().filter(|from| reach[from].contains(*from)) {
            if !knots.iter().any(|knot| knot.contains(from)) {
                let back = |to: &&Module| reach[*to].contains(from);
                knots.push(reach[from].iter().filter(back).cloned().collect());
            }
        }
        knots
    }

    /// A shortest way from a file back to itself.
    pub fn circle(&self, from: &Module) -> Vec<Module> {
        let mut ways = std::collections::VecDeque::from([vec![from.clone()]]);
        let mut seen = BTreeSet::new();
        while let Some(way) = ways.pop_front() {
            for to in &self.needs[way.last().expect("a beginning")] {
                let mut longer = way.clone();
                longer.push(to.clone());
                if to == from {
                    return longer;
                }
                if seen.insert(to.clone()) {
                    ways.push_back(longer);
                }
            }
        }
        Vec::new()
    }

    fn reached(&self, from: &Module) -> BTreeSet<Module> {
        let (mut reached, mut next) = (BTreeSet::new(), vec![from]);
        while let Some(module) = next.pop() {
            next.extend(self.needs[module].iter().filter(|to| reached.insert((*to).clone())));
        }
        reached
    }

    fn read(&mut self, file: &Path, children_in: &Path, module: Module) {
        let text =
            fs::read_to_string(file).unwrap_or_else(|why| panic!("{}: {why}", file.display()));
        let tokens = without_tests(&tokens(&text));
        let source = Source::of(tokens, &module);
        for child in source.children.clone() {
            let flat = children_in.join(format!("{child}.rs"));
            let nested = children_in.join(&child);
            let path = if flat.is_file() { flat } else { nested.join("mod.rs") };
            let mut below = module.clone();
            below.push(child);
            self.read(&path, &nested, below);
        }
        self.files.insert(module, source);
    }

    fn link(&mut self) {
        for (module, source) in &self.files {
            for (inside, path, import) in &source.paths {
                if let (Some(import), Some(to)) = (import, self.absolute(module, inside, path)) {
                    self.aliases.insert((module.clone(), import.name.clone()), to);
                }
            }
        }
        for (module, source) in &self.files {
            let mut needs = BTreeSet::new();
            for (inside, path, import) in &source.paths {
                let Some(to) = self.absolute(module, inside, path) else { continue };
                let (to, rest) = self.defining(to);
                // A module that is only brought into scope is needed where something in it is named.
                let named = !rest.is_empty();
                let shown = import.as_ref().is_some_and(|import| {
                    let below = to.len() > module.len() && to.starts_with(module);
                    import.public && below && !source.mentions(&import.name)
                });
                if named && !shown && to != *module {
                    needs.insert(to);
                }
            }
            self.needs.insert(module.clone(), needs);
        }
    }

    /// A path as seen from the crate's root; `None` when it leads out of the crate.
    fn absolute(&self, module: &Module, inside: &Module, path: &[String]) -> Option<Vec<String>> {
        let mut at = inside.clone();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" => {
                at.clear();
                rest = &rest[1..];
            }
            "self" | "super" => {
                while let Some(first @ ("self" | "super")) = rest.first().map(String::as_str) {
                    if first == "super" {
                        at.pop()?;
                    }
                    rest = &rest[1..];
                }
            }
            first if self.files[module].children.contains(first) => at = module.clone(),
            first => {
                let alias = self.aliases.get(&(module.clone(), first.to_string()))?;
                let more = path[1..].iter().cloned();
                return (path.len() > 1).then(|| alias.iter().cloned().chain(more).collect());
            }
        }
        at.extend(rest.iter().cloned());
        Some(at)
    }

    /// The file in which a path ends, and what it names there; followed through re-exports.
    fn defining(&self, mut path: Vec<String>) -> (Module, Vec<String>) {
        for _ in 0..16 {
            let length = (0..=path.len()).rev().find(|&n| self.files.contains_key(&path[..n]));
            let (module, rest) = path.split_at(length.expect("the root is a file"));
            let alias = rest
                .first()
                .and_then(|name| self.aliases.get(&(module.to_vec(), name.clone())))
                .map(|to| to.iter().chain(&rest[1..]).cloned().collect::<Vec<_>>());
            match alias {
                // A module in the file takes it from the file itself.
                Some(to) if to != path => path = to,
                _ => return (module.to_vec(), rest.to_vec()),
            }
        }
        panic!("{path:?}: re-exported in a circle");
    }
}

impl Source {
    fn of(tokens: Vec<String>, module: &Module) -> Self {
        let mut source = Self { tokens, children: BTreeSet::new(), paths: Vec::new() };
        let mut inline: Vec<(String, usize)> = Vec::new();
        let (mut depth, mut i) = (0, 0);
        let tokens = source.tokens.clone();
        while i < tokens.len() {
            let token = tokens[i].as_str();
            let next = tokens.get(i + 1).map_or("", String::as_str);
            let before = if i == 0 { "" } else { tokens[i - 1].as_str() };
            let inside = || {
                let names = inline.iter().map(|(name, _)| name.clone());
                module.iter().cloned().chain(names).collect::<Module>()
            };
            match token {
                "{" => depth += 1,
                "}" => {
                    depth -= 1;
                    inline.retain(|(_, opened)| *opened <= depth);
                }
                "mod" if tokens.get(i + 2).is_some_and(|t| t == ";") => {
                    source.children.insert(next.to_string());
                }
                "mod" if tokens.get(i + 2).is_some_and(|t| t == "{") => {
                    inline.push((next.to_string(), depth + 1));
                }
                "use" if next != "<" => {
                    let public = before == "pub" || before == ")";
                    let mut leaves = Vec::new();
                    i = use_tree(&tokens, i + 1, &mut Vec::new(), &mut leaves);
                    for (path, name) in leaves {
                        source.paths.push((inside(), path, Some(Import { name, public })));
                    }
                    continue;
                }
                _ if is_name(token) && next == "::" && before != "::" && before != "." => {
                    let mut path = vec![token.to_string()];
                    while tokens[i + 1] == "::" && is_name(&tokens[i + 2]) {
                        path.push(tokens[i + 2].clone());
                        i += 2;
                    }
                    source.paths.push((inside(), path, None));
                }
                _ => {}
            }
            i += 1;
        }
        source
    }

    /// Whether a name stands anywhere but in a `use` or where a module is declared.
    fn mentions(&self, name: &str) -> bool {
        let (mut in_use, mut before) = (false, "");
        self.tokens.iter().any(|token| {
            in_use = (in_use || token == "use") && token != ";";
            let declared = std::mem::replace(&mut before, token) == "mod";
            !in_use && !declared && token == name
        })
    }
}

/// Reads one tree of a `use` and gives the place after it.
fn use_tree(
    tokens: &[String],
    mut i: usize,
    path: &mut Vec<String>,
    leaves: &mut Vec<(Vec<String>, String)>,
) -> usize {
    let length = path.len();
    loop {
        match tokens[i].as_str() {
            "::" => i += 1,
            "{" => {
                i += 1;
                while tokens[i] != "}" {
                    i = use_tree(tokens, i, path, leaves);
                    if tokens[i] == "," {
                        i += 1;
                    }
                }
                i += 1;
                break;
            }
            "as" => {
                let name = tokens[i + 1].clone();
                leaves.last_mut().expect("what is renamed").1 = name;
                i += 2;
                break;
            }
            "," | "}" | ";" => break,
            token => {
                // `self` at the end of a tree is the module itself.
                if token != "self" || path.is_empty() {
                    path.push(token.to_string());
                }
                i += 1;
                if !matches!(tokens[i].as_str(), "::") {
                    let name = path.last().expect("a name").clone();
                    leaves.push((path.clone(), name));
                }
            }
        }
    }
    path.truncate(length);
    i
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// The tokens without the items that are compiled for tests only.
fn without_tests(tokens: &[String]) -> Vec<String> {
    const TEST: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        if tokens[i..].iter().zip(TEST).filter(|(token, test)| token == test).count() < TEST.len() {
            kept.push(tokens[i].clone());
            i += 1;
            continue;
        }
        i += TEST.len();
        // To the end of the item: a semicolon, the brace that closes its body, or a field's comma.
        let mut depth = 0;
        loop {
            match tokens[i].as_str() {
                "{" | "(" | "[" => depth += 1,
                "}" | ")" | "]" => depth -= 1,
                _ => {}
            }
            i += 1;
            if depth == 0 && matches!(tokens[i - 1].as_str(), ";" | "}" | ",") {
                break;
            }
        }
    }
    kept
}

/// Names, `::` and single characters; comments, strings, characters and lifetimes left out.
fn tokens(text: &str) -> Vec<String> {
    let c: Vec<char> = text.chars().collect();
    let at = |i: usize| c.get(i).copied().unwrap_or('\0');
    let mut found = Vec::new();
    let mut i = 0;
    while i < c.len() {
        match (at(i), at(i + 1)) {
            ('/', '/') => i = end_of(&c, i, "\n"),
            ('/', '*') => i = end_of(&c, i + 2, "*/"),
            ('"', _) => i = end_of_string(&c, i + 1),
            ('r', '"' | '#') | ('b', 'r') if raw_string(&c, i).is_some() => {
                i = raw_string(&c, i).expect("a raw string");
            }
            ('\'', '\\') => i = end_of(&c, i + 3, "'"),
            ('\'', _) if at(i + 2) == '\'' => i += 3,
            ('\'', _) => i += 1 + name_length(&c[i + 1..]).max(1),
            (':', ':') => {
                found.push("::".to_string());
                i += 2;
            }
            (first, _) => {
                let length = name_length(&c[i..]).max(1);
                if !first.is_whitespace() {
                    found.push(c[i..i + length].iter().collect());
                }
                i += length;
            }
        }
    }
    found
}

fn name_length(c: &[char]) -> usize {
    c.iter().take_while(|c| c.is_alphanumeric() || **c == '_').count()
}

/// The place after the next `end`.
fn end_of(c: &[char], from: usize, end: &str) -> usize {
    let end: Vec<char> = end.chars().collect();
    (from..c.len()).find(|&i| c[i..].starts_with(&end)).map_or(c.len(), |i| i + end.len())
}

fn end_of_string(c: &[char], mut i: usize) -> usize {
    while i < c.len() && c[i] != '"' {
        i += if c[i] == '\\' { 2 } else { 1 };
    }
    i + 1
}

/// The place after a raw string, if one begins here.
fn raw_string(c: &[char], from: usize) -> Option<usize> {
    let begin = if c[from] == 'b' { from + 2 } else { from + 1 };
    let hashes = c[begin..].iter().take_while(|c| **c == '#').count();
    let quoted = c.get(begin + hashes) == Some(&'"');
    let end = format!("\"{}", "#".repeat(hashes));
    quoted.then(|| end_of(c, begin + hashes + 1, &end))
}

/// The first files of a package: of its library and of its programs.
pub fn roots(folder: &Path, manifest: &toml::Table) -> Vec<PathBuf> {
    let named = |table: &toml::Value| Some(folder.join(table.get("path")?.as_str()?));
    let mut roots = vec![folder.join("src/lib.rs"), folder.join("src/main.rs")];
    roots.extend(manifest.get("lib").and_then(named));
    let programs = manifest.get("bin").and_then(toml::Value::as_array);
    roots.extend(programs.into_iter().flatten().filter_map(named));
    if let Ok(programs) = fs::read_dir(folder.join("src/bin")) {
        roots.extend(programs.flatten().map(|entry| entry.path()));
    }
    roots.retain(|root| root.is_file());
    roots.sort();
    roots.dedup();
    roots
}
