//! The modules of one crate and the files that define its items.
//!
//! A path is followed through modules, imports, re-exports and globs to the module that defines its item:
//! `use super::X` leads to the sibling that defines `X` if the parent only re-exports it. Code under
//! `#[cfg(test)]` is ignored.

pub mod names;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path as FilePath, PathBuf};

use quote::ToTokens;
use syn::{Attribute, Expr, ForeignItem, Item, Lit, Meta};

use names::{Names, Path};

/// Gives a file's text, if there is such a file.
pub type ReadFile<'a> = &'a dyn Fn(&FilePath) -> Option<String>;

/// The modules of a crate; the first is its root.
#[derive(Default)]
pub struct Crate {
    /// A module refers to others by index.
    pub modules: Vec<Module>,
}

/// A module, inline or in a file of its own.
#[derive(Default)]
pub struct Module {
    /// The file that holds its items.
    pub file: PathBuf,
    /// The folder of its child modules' files.
    folder: PathBuf,
    parent: Option<usize>,
    /// Child modules by name.
    children: BTreeMap<String, usize>,
    /// The names that its items define.
    defined: BTreeSet<String>,
    /// The names that its items use.
    pub names: Names,
}

impl Crate {
    /// Reads a crate from its root file. Errors: a file is missing or does not parse.
    pub fn load(root: &FilePath, read: ReadFile<'_>) -> Result<Self, String> {
        let mut loaded = Self::default();
        let folder = root.parent().unwrap_or(root).to_path_buf();
        loaded.load_file(root, folder, None, read)?;
        Ok(loaded)
    }

    fn load_file(
        &mut self,
        file: &FilePath,
        folder: PathBuf,
        parent: Option<usize>,
        read: ReadFile<'_>,
    ) -> Result<usize, String> {
        let text = read(file).ok_or_else(|| format!("{} cannot be read", file.display()))?;
        let parsed = syn::parse_file(&text).map_err(|error| format!("{}: {error}", file.display()))?;
        self.load_module(parsed.items, file, folder, parent, read)
    }

    fn load_module(
        &mut self,
        items: Vec<Item>,
        file: &FilePath,
        folder: PathBuf,
        parent: Option<usize>,
        read: ReadFile<'_>,
    ) -> Result<usize, String> {
        let index = self.modules.len();
        self.modules.push(Module { file: file.to_path_buf(), folder, parent, ..Module::default() });
        let mut code = proc_macro2::TokenStream::new();
        for item in items {
            match item {
                item if is_test(attributes(&item)) => {}
                Item::Mod(module) => {
                    let name = unraw(&module.ident);
                    let child = match module.content {
                        Some((_, items)) => {
                            let folder = self.modules[index].folder.join(&name);
                            self.load_module(items, file, folder, Some(index), read)?
                        }
                        None => self.load_child(&name, &module.attrs, index, read)?,
                    };
                    self.modules[index].children.insert(name, child);
                }
                item => {
                    self.modules[index].defined.extend(defined_names(&item));
                    item.to_tokens(&mut code);
                }
            }
        }
        self.modules[index].names = Names::of(code);
        Ok(index)
    }

    /// Loads the file of `mod name;`.
    fn load_child(
        &mut self,
        name: &str,
        attributes: &[Attribute],
        parent: usize,
        read: ReadFile<'_>,
    ) -> Result<usize, String> {
        let Module { file, folder, .. } = &self.modules[parent];
        if let Some(path) = path_attribute(attributes) {
            let file = file.parent().unwrap_or(file).join(path);
            let folder = file.parent().unwrap_or(&file).to_path_buf();
            return self.load_file(&file, folder, Some(parent), read);
        }
        let folder = folder.join(name);
        let files = [folder.with_extension("rs"), folder.join("mod.rs")];
        let found = files.iter().find(|file| read(file).is_some());
        let file = found.ok_or_else(|| format!("{} has no file for `mod {name}`", file.display()))?;
        self.load_file(file, folder, Some(parent), read)
    }

    /// The module that defines the item that a path leads to, and the item's name. A path is relative to the
    /// module `from`.
    pub fn item(&self, from: usize, path: &[String]) -> Option<(usize, String)> {
        self.find_item(from, path, &mut BTreeSet::new())
    }

    /// [`Crate::item`]. `visited` holds the places where a search is under way.
    fn find_item(
        &self,
        from: usize,
        path: &[String],
        visited: &mut BTreeSet<(usize, Path)>,
    ) -> Option<(usize, String)> {
        if !visited.insert((from, path.to_vec())) {
            return None;
        }
        let (mut module, mut rest) = self.start(from, path)?;
        let is_qualified = rest.len() < path.len();
        while let [name, after @ ..] = rest {
            let child = self.module(module, name, visited);
            match child {
                Some(child) if !after.is_empty() => (module, rest) = (child, after),
                _ => {
                    let found = self.item_in(module, name, visited);
                    // A name that no item has may be a macro's product.
                    let qualified = is_qualified || rest.len() < path.len();
                    let unknown = (child.is_none() && qualified).then(|| (module, name.clone()));
                    return found.or(unknown);
                }
            }
        }
        None
    }

    /// Resolves `crate`, `self` and `super` at the beginning of a path.
    fn start<'a>(&self, from: usize, path: &'a [String]) -> Option<(usize, &'a [String])> {
        let (mut module, mut rest) = (from, path);
        while let [name, after @ ..] = rest {
            module = match name.as_str() {
                "crate" => 0,
                "self" => module,
                "super" => self.modules[module].parent?,
                _ => break,
            };
            rest = after;
        }
        Some((module, rest))
    }

    /// The module that `name` stands for inside a module: a child or an import.
    fn module(&self, of: usize, name: &str, visited: &mut BTreeSet<(usize, Path)>) -> Option<usize> {
        let module = &self.modules[of];
        let imported = || {
            let mut paths = module.names.imports.iter().filter(|(import, _)| import == name);
            paths.find_map(|(_, path)| self.find_module(of, path, visited))
        };
        module.children.get(name).copied().or_else(imported)
    }

    /// The module that a path leads to. `visited` holds the places where a search is under way.
    fn find_module(
        &self,
        from: usize,
        path: &[String],
        visited: &mut BTreeSet<(usize, Path)>,
    ) -> Option<usize> {
        let mut key = path.to_vec();
        key.push("mod".to_owned());
        if !visited.insert((from, key)) {
            return None;
        }
        let (start, rest) = self.start(from, path)?;
        rest.iter().try_fold(start, |module, name| self.module(module, name, visited))
    }

    /// The definer of an item that `name` stands for inside a module: an item, an import or a glob's.
    fn item_in(
        &self,
        of: usize,
        name: &str,
        visited: &mut BTreeSet<(usize, Path)>,
    ) -> Option<(usize, String)> {
        let module = &self.modules[of];
        if module.defined.contains(name) {
            return Some((of, name.to_owned()));
        }
        let mut imports = module.names.imports.iter().filter(|(import, _)| import == name);
        imports.find_map(|(_, path)| self.find_item(of, path, visited)).or_else(|| {
            module.names.globs.iter().find_map(|path| {
                let from = self.find_module(of, path, &mut BTreeSet::new())?;
                let first_visit = visited.insert((from, vec!["*".to_owned(), name.to_owned()]));
                first_visit.then(|| self.item_in(from, name, visited)).flatten()
            })
        })
    }

    /// The module whose `macro_rules!` a name before `!` means: an import, or the nearest module around it.
    pub fn macro_definer(&self, from: usize, name: &str) -> Option<usize> {
        let imported = self.item_in(from, name, &mut BTreeSet::new()).map(|(definer, _)| definer);
        let around = std::iter::successors(Some(from), |&module| self.modules[module].parent);
        imported.or_else(|| around.into_iter().find(|&module| self.modules[module].defined.contains(name)))
    }
}

/// A name without `r#`.
fn unraw(ident: &proc_macro2::Ident) -> String {
    ident.to_string().trim_start_matches("r#").to_owned()
}

/// The names that an item defines in its module.
fn defined_names(item: &Item) -> Vec<String> {
    let ident = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Macro(item) => return item.ident.iter().map(unraw).collect(),
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::TraitAlias(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        Item::ForeignMod(block) => {
            let functions = block.items.iter().filter_map(|item| match item {
                ForeignItem::Fn(function) => Some(unraw(&function.sig.ident)),
                _ => None,
            });
            return functions.collect();
        }
        _ => return Vec::new(),
    };
    vec![unraw(ident)]
}

/// The attributes of an item.
fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// True where an item is compiled for tests only.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) if list.path.is_ident("cfg") => {
            let names = Names::of(list.tokens.clone());
            let has = |word: &str| names.paths.iter().any(|path| path[..] == [word.to_owned()]);
            has("test") && !has("not")
        }
        meta => meta.path().is_ident("test"),
    })
}

/// The text of `#[path = "text"]`.
fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    attributes.iter().find_map(|attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(text) => Some(text.value()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    })
}
