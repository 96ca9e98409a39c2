//! Which modules import which, read from the sources, and the circles among them.

use std::collections::{BTreeMap, BTreeSet};

/// A module: what its own code names. Test code does not count.
#[derive(Default)]
struct Module {
    children: BTreeSet<String>,
    /// What its `use` declarations call what, by path, and whether others can import it from here.
    imports: BTreeMap<String, (Vec<String>, bool)>,
    /// Paths in the code itself.
    paths: Vec<Vec<String>>,
    /// Every word of the code but for its imports.
    words: BTreeSet<String>,
}

/// The modules of a crate by path (`a::b`; the root is empty).
pub(crate) struct Modules(BTreeMap<String, Module>);

impl Modules {
    /// From the sources under src/, each with its path there: those that a `mod` declaration outside tests reaches.
    pub(crate) fn of(sources: &[(String, String)]) -> Self {
        let mut modules = BTreeMap::new();
        let mut open = vec![(String::new(), "lib".to_string())];
        while let Some((path, file)) = open.pop() {
            let folder = if path.is_empty() { String::new() } else { format!("{}/", path.replace("::", "/")) };
            let is_it =
                |(name, _): &&(String, String)| *name == format!("{file}.rs") || *name == format!("{folder}mod.rs");
            let Some((_, source)) = sources.iter().find(is_it) else { continue };
            let module = Module::read(source);
            for child in &module.children {
                open.push((below(&path, child), format!("{folder}{child}")));
            }
            modules.insert(path, module);
        }
        Self(modules)
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.0.len()
    }

    /// The module that defines what `path` means within `module`; re-exports are followed to where the thing is.
    fn resolve(&self, module: &str, path: &[String], depth: usize) -> Option<String> {
        let (first, mut rest) = path.split_first()?;
        let mut at = match first.as_str() {
            "crate" => String::new(),
            "self" => module.to_string(),
            "super" => parent(module)?,
            _ => {
                rest = path;
                let here = self.0.get(module)?;
                if !here.children.contains(first) && !here.imports.contains_key(first) {
                    return None;
                }
                module.to_string()
            }
        };
        while let Some((name, after)) = rest.split_first() {
            let here = self.0.get(&at)?;
            if name == "super" {
                at = parent(&at)?;
            } else if here.children.contains(name) {
                at = below(&at, name);
            } else if let (Some((path, _)), true) = (here.imports.get(name), depth < 8) {
                let whole: Vec<String> = path.iter().chain(after).cloned().collect();
                return self.resolve(&at, &whole, depth + 1);
            } else {
                return Some(at);
            }
            rest = after;
        }
        self.0.contains_key(&at).then_some(at)
    }

    /// What a module's own code needs.
    fn needs(&self, path: &str) -> BTreeSet<String> {
        let module = &self.0[path];
        // What is only passed on to others is no need of one's own.
        let used = module.imports.iter().filter(|(name, (_, is_public))| !is_public || module.words.contains(*name));
        let paths = used.map(|(_, (path, _))| path).chain(&module.paths);
        let mut needs: BTreeSet<String> = paths.filter_map(|wanted| self.resolve(path, wanted, 0)).collect();
        needs.remove(path);
        needs
    }

    /// Every set of modules that need each other in a circle.
    pub(crate) fn circles(&self) -> Vec<Vec<String>> {
        let needs: BTreeMap<&str, BTreeSet<String>> =
            self.0.keys().map(|path| (path.as_str(), self.needs(path))).collect();
        let mut reached: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for &from in needs.keys() {
            let (mut found, mut open) = (BTreeSet::new(), vec![from]);
            while let Some(path) = open.pop() {
                open.extend(needs[path].iter().map(String::as_str).filter(|next| found.insert(*next)));
            }
            reached.insert(from, found);
        }
        let mut circles = BTreeSet::new();
        for (path, all) in &reached {
            let circle: Vec<String> =
                all.iter().filter(|other| reached[*other].contains(path)).map(|other| (*other).to_string()).collect();
            if !circle.is_empty() {
                circles.insert(circle);
            }
        }
        circles.into_iter().collect()
    }
}

fn below(path: &str, child: &str) -> String {
    if path.is_empty() { child.to_string() } else { format!("{path}::{child}") }
}

fn parent(path: &str) -> Option<String> {
    if path.is_empty() { None } else { Some(path.rsplit_once("::").map_or("", |(parent, _)| parent).to_string()) }
}

impl Module {
    fn read(source: &str) -> Self {
        let mut module = Self::default();
        let (mut code, mut attributes) = (String::new(), String::new());
        let mut lines = source.lines().map(|line| line.split("//").next().unwrap_or_default());
        while let Some(line) = lines.next() {
            let item = line.trim();
            if item.starts_with("#[") {
                attributes.push_str(item);
                continue;
            }
            let is_test = std::mem::take(&mut attributes).contains("cfg(test)");
            let (visibility, item) = match item.strip_prefix("pub") {
                Some(rest) if rest.starts_with('(') => rest.split_once(") ").unwrap_or_default(),
                Some(rest) if rest.starts_with(' ') => ("pub", rest.trim_start()),
                _ => ("", item),
            };
            if let Some(name) = item.strip_prefix("mod ") {
                match (is_test, name.strip_suffix(';')) {
                    (false, Some(name)) => {
                        module.children.insert(name.to_string());
                    }
                    // A module in place: over when a line is as far in as its head again.
                    (true, None) => {
                        let indent = line.len() - line.trim_start().len();
                        let end = format!("{}}}", " ".repeat(indent));
                        lines.by_ref().find(|line| *line == end);
                    }
                    _ => {}
                }
            } else if let Some(tree) = item.strip_prefix("use ") {
                let mut tree = tree.to_string();
                while !tree.contains(';') {
                    let Some(line) = lines.next() else { break };
                    tree.push_str(line);
                }
                if !is_test {
                    module.take_use(&[], tree.trim_end_matches(';'), !visibility.is_empty());
                }
            } else {
                code.push_str(line);
                code.push('\n');
            }
        }
        module.take_code(&code);
        module
    }

    /// The leaves of a `use` tree.
    fn take_use(&mut self, before: &[String], tree: &str, is_public: bool) {
        let tree = tree.trim();
        if let Some((path, list)) = tree.split_once('{') {
            let mut before = before.to_vec();
            before.extend(path.split("::").map(str::trim).filter(|name| !name.is_empty()).map(str::to_string));
            let (mut depth, mut start) = (0, 0);
            let list = &list[..list.rfind('}').unwrap_or(list.len())];
            for (at, letter) in list.char_indices().chain([(list.len(), ',')]) {
                match letter {
                    '{' => depth += 1,
                    '}' => depth -= 1,
                    ',' if depth == 0 => {
                        self.take_use(&before, &list[start..at], is_public);
                        start = at + 1;
                    }
                    _ => {}
                }
            }
            return;
        }
        if tree.is_empty() {
            return;
        }
        let (path, alias) = tree.split_once(" as ").map_or((tree, None), |(path, alias)| (path, Some(alias)));
        let mut whole = before.to_vec();
        whole.extend(path.split("::").map(|name| name.trim().to_string()));
        if whole.last().is_some_and(|name| name == "self") && whole.len() > 1 {
            whole.pop();
        }
        let name = alias.or(whole.last().map(String::as_str)).unwrap_or_default();
        // A trait without a name, and everything of a module, under a name of their own.
        let name = if name == "_" || name == "*" { whole.join("::") } else { name.to_string() };
        self.imports.insert(name, (whole, is_public));
    }

    /// The words of the code, and those of its paths that may lead to another module of the crate.
    fn take_code(&mut self, code: &str) {
        for path in code.split(|letter: char| !(letter.is_alphanumeric() || letter == '_' || letter == ':')) {
            let names: Vec<String> = path.split("::").map(|name| name.trim_matches(':').to_string()).collect();
            let is_local = |name: &str| ["crate", "super", "self"].contains(&name) || self.children.contains(name);
            if names.len() > 1 && is_local(&names[0]) {
                self.paths.push(names.clone());
            }
            self.words.extend(names);
        }
    }
}
