//! The lines of an API list: one per public item, field, variant, method and implementation, sorted.
//!
//! The public modules are walked from the crate's root. An item is listed at its shortest public path; its other paths are `pub use` lines.

use std::collections::{BTreeMap, BTreeSet};

use quote::ToTokens;
use syn::{
    Attribute, Fields, FnArg, GenericParam, ImplItem, Item, ItemEnum, ItemImpl, ItemStruct, ItemTrait, Pat,
    PatWild, Signature, TraitItem, Type, Visibility,
};

use super::text::line;
use crate::rust_code::names::{Names, Path};
use crate::rust_code::{Crate, attributes, is_hidden, unraw};

/// A module and the name of an item in it.
type Definition = (usize, String);

/// The sorted lines of a crate's public API.
pub fn lines(code: &Crate, name: &str) -> Vec<String> {
    let mut listing = Listing { code, paths: BTreeMap::new(), lines: BTreeSet::new() };
    listing.walk(0, name, &mut BTreeSet::new());
    let paths = listing.paths.clone();
    for ((module, item), paths) in &paths {
        listing.item(*module, item, paths);
    }
    listing.implementations();
    let mut lines: Vec<String> = listing.lines.into_iter().collect();
    lines.sort_by_cached_key(|line| (path_in(line, name), line.clone()));
    lines
}

/// The first path of the crate in a line, by which lines are sorted, so that a type's lines are neighbours.
fn path_in(line: &str, name: &str) -> String {
    let start = line.find(&format!("{name}::")).unwrap_or(line.len());
    let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    line[start..].split(|c| !is_path(c)).next().unwrap_or_default().trim_end_matches(':').to_owned()
}

struct Listing<'a> {
    code: &'a Crate,
    /// The public paths of each public item, the shortest first.
    paths: BTreeMap<Definition, BTreeSet<(usize, String)>>,
    lines: BTreeSet<String>,
}

impl Listing<'_> {
    /// Notes the public items of a module under a path. `visited` holds the modules around it, which globs may lead back to.
    fn walk(&mut self, module: usize, path: &str, visited: &mut BTreeSet<usize>) {
        if !visited.insert(module) {
            return;
        }
        let code = self.code;
        for item in &code.modules[module].items {
            match item {
                _ if is_hidden(attributes(item)) => {}
                Item::Use(used) if is_public(&used.vis) => self.walk_use(module, used, path, visited),
                item => {
                    if let Some(name) = public_name(item) {
                        self.note((module, name.clone()), &format!("{path}::{name}"));
                    }
                }
            }
        }
        for (name, &child) in &code.modules[module].children {
            if code.modules[child].is_public {
                self.lines.insert(format!("pub mod {path}::{name}"));
                self.walk(child, &format!("{path}::{name}"), visited);
            }
        }
        visited.remove(&module);
    }

    fn walk_use(&mut self, module: usize, used: &syn::ItemUse, path: &str, visited: &mut BTreeSet<usize>) {
        let names = Names::of(used.to_token_stream());
        for (name, target) in &names.imports {
            let to = format!("{path}::{name}");
            match (self.code.module_at(module, target), self.defined(module, target)) {
                (_, Some(definition)) => self.note(definition, &to),
                (Some(child), None) => {
                    self.lines.insert(format!("pub mod {to}"));
                    self.walk(child, &to, visited);
                }
                (None, None) => _ = self.lines.insert(format!("pub use {} as {to}", target.join("::"))),
            }
        }
        for target in &names.globs {
            match self.code.module_at(module, target) {
                Some(child) => self.walk(child, path, visited),
                None => _ = self.lines.insert(format!("pub use {}::* in {path}", target.join("::"))),
            }
        }
    }

    /// The definition that a path leads to, if an item of this crate has it.
    fn defined(&self, module: usize, path: &Path) -> Option<Definition> {
        let (definer, name) = self.code.item(module, path)?;
        let is_item =
            self.code.modules[definer].items.iter().any(|item| public_name(item).as_ref() == Some(&name));
        is_item.then_some((definer, name))
    }

    fn note(&mut self, definition: Definition, path: &str) {
        let depth = path.matches("::").count();
        self.paths.entry(definition).or_default().insert((depth, path.to_owned()));
    }

    /// Lists an item at its shortest path.
    fn item(&mut self, module: usize, name: &str, paths: &BTreeSet<(usize, String)>) {
        let Some((_, path)) = paths.first() else { return };
        for (_, other) in paths.iter().skip(1) {
            self.lines.insert(format!("pub use {path} as {other}"));
        }
        let code = self.code;
        for item in &code.modules[module].items {
            if public_name(item).as_deref() == Some(name) {
                match item {
                    Item::Struct(item) => self.structure(item, path),
                    Item::Enum(item) => self.enumeration(item, path),
                    Item::Trait(item) => self.trait_of(item, path),
                    Item::Fn(item) => self.add(&signature("pub ", &item.sig, path)),
                    Item::Const(item) => self.add(&format!("pub const {path}: {}", line(&item.ty))),
                    Item::Static(item) => self.add(&format!("pub static {path}: {}", line(&item.ty))),
                    Item::Type(item) => {
                        self.add(&format!("pub type {path}{} = {}", line(&item.generics), line(&item.ty)));
                    }
                    Item::Macro(_) => self.add(&format!("macro {path}!")),
                    _ => {}
                }
            }
        }
    }

    fn add(&mut self, text: &str) {
        self.lines.insert(text.to_owned());
    }

    fn structure(&mut self, item: &ItemStruct, path: &str) {
        let private = item.fields.iter().any(|field| !is_public(&field.vis));
        let end = if private { " { private fields }" } else { "" };
        let marks = marks(&item.attrs);
        self.add(&format!("{marks}pub struct {path}{}{}{end}", line(&item.generics), bounds(&item.generics)));
        for (index, field) in item.fields.iter().enumerate() {
            if is_public(&field.vis) {
                let name = field.ident.as_ref().map_or_else(|| index.to_string(), unraw);
                self.add(&format!("pub {path}::{name}: {}", line(&field.ty)));
            }
        }
    }

    fn enumeration(&mut self, item: &ItemEnum, path: &str) {
        self.add(&format!(
            "{}pub enum {path}{}{}",
            marks(&item.attrs),
            line(&item.generics),
            bounds(&item.generics)
        ));
        for variant in &item.variants {
            let types = variant.fields.iter().map(|field| match &field.ident {
                Some(ident) => format!("{}: {}", unraw(ident), line(&field.ty)),
                None => line(&field.ty),
            });
            let types = types.collect::<Vec<_>>().join(", ");
            let fields = match &variant.fields {
                Fields::Unit => String::new(),
                Fields::Unnamed(_) => format!("({types})"),
                Fields::Named(_) => format!(" {{ {types} }}"),
            };
            self.add(&format!("{path}::{}{fields}", unraw(&variant.ident)));
        }
    }

    fn trait_of(&mut self, item: &ItemTrait, path: &str) {
        let supertraits = if item.supertraits.is_empty() {
            String::new()
        } else {
            format!(": {}", line(&item.supertraits))
        };
        self.add(&format!("pub trait {path}{}{supertraits}{}", line(&item.generics), bounds(&item.generics)));
        for part in &item.items {
            match part {
                TraitItem::Fn(function) => {
                    let provided = if function.default.is_some() { " { provided }" } else { "" };
                    let name = unraw(&function.sig.ident);
                    self.add(&(signature("", &function.sig, &format!("{path}::{name}")) + provided));
                }
                TraitItem::Const(constant) => {
                    self.add(&format!("const {path}::{}: {}", constant.ident, line(&constant.ty)));
                }
                TraitItem::Type(part) => self.add(&format!("type {path}::{}", part.ident)),
                _ => {}
            }
        }
    }

    /// Lists the implementations of all modules that concern public types and traits.
    fn implementations(&mut self) {
        let code = self.code;
        for (index, module) in code.modules.iter().enumerate() {
            for item in &module.items {
                match item {
                    Item::Impl(item) if !is_hidden(&item.attrs) => self.implementation(index, item),
                    _ => {}
                }
            }
        }
    }

    fn implementation(&mut self, module: usize, item: &ItemImpl) {
        let own_type = self.public_path(module, &item.self_ty);
        match (&item.trait_, own_type) {
            (None, Some(path)) => self.methods(item, &path),
            (Some((of, _)), own_type) => {
                let segments: Path = of.segments.iter().map(|segment| unraw(&segment.ident)).collect();
                let own_trait = self.defined(module, &segments).map(|found| self.paths.contains_key(&found));
                let is_local_trait = self.code.item(module, &segments).is_some();
                let is_public = own_trait.unwrap_or(!is_local_trait);
                let concerns = own_type.is_some() || own_trait == Some(true);
                let name = segments.last().map_or("", String::as_str);
                if is_public && concerns && name != "StructuralPartialEq" {
                    let of = line(&of.segments.last());
                    let to = own_type.map_or_else(
                        || line(&item.self_ty),
                        |path| path + &line(&last_arguments(&item.self_ty)),
                    );
                    let generics = line(&item.generics);
                    self.add(&format!("impl{generics} {of} for {to}{}", bounds(&item.generics)));
                }
            }
            (None, None) => {}
        }
    }

    /// Lists the public methods and constants of an inherent implementation.
    fn methods(&mut self, item: &ItemImpl, path: &str) {
        let has_types =
            item.generics.params.iter().any(|parameter| matches!(parameter, GenericParam::Type(_)));
        let place = if has_types {
            format!(" in impl{} {}{}", line(&item.generics), line(&item.self_ty), bounds(&item.generics))
        } else {
            String::new()
        };
        for part in &item.items {
            match part {
                ImplItem::Fn(method) if is_public(&method.vis) && !is_hidden(&method.attrs) => {
                    let name = unraw(&method.sig.ident);
                    self.add(&(signature("pub ", &method.sig, &format!("{path}::{name}")) + &place));
                }
                ImplItem::Const(constant) if is_public(&constant.vis) && !is_hidden(&constant.attrs) => {
                    self.add(&format!("pub const {path}::{}: {}{place}", constant.ident, line(&constant.ty)));
                }
                _ => {}
            }
        }
    }

    /// The public path of a type of this crate.
    fn public_path(&self, module: usize, of: &Type) -> Option<String> {
        let Type::Path(of) = of else { return None };
        let segments: Path = of.path.segments.iter().map(|segment| unraw(&segment.ident)).collect();
        let definition = self.defined(module, &segments)?;
        self.paths.get(&definition)?.first().map(|(_, path)| path.clone())
    }
}

/// The generic arguments of a type, such as `<'_>`.
fn last_arguments(of: &Type) -> Option<&syn::PathArguments> {
    match of {
        Type::Path(of) => of.path.segments.last().map(|segment| &segment.arguments),
        _ => None,
    }
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

/// The name of an item that is declared `pub`, or of an exported macro.
fn public_name(item: &Item) -> Option<String> {
    let (visibility, ident) = match item {
        Item::Const(item) => (&item.vis, &item.ident),
        Item::Enum(item) => (&item.vis, &item.ident),
        Item::Fn(item) => (&item.vis, &item.sig.ident),
        Item::Static(item) => (&item.vis, &item.ident),
        Item::Struct(item) => (&item.vis, &item.ident),
        Item::Trait(item) => (&item.vis, &item.ident),
        Item::Type(item) => (&item.vis, &item.ident),
        Item::Macro(item) if item.attrs.iter().any(|attribute| attribute.path().is_ident("macro_export")) => {
            return item.ident.as_ref().map(unraw);
        }
        _ => return None,
    };
    is_public(visibility).then(|| unraw(ident))
}

/// Attributes that are part of an item's promise.
fn marks(attributes: &[Attribute]) -> String {
    let marks = attributes.iter().filter(|attribute| {
        ["non_exhaustive", "must_use", "repr"].iter().any(|name| attribute.path().is_ident(name))
    });
    marks.map(|attribute| line(attribute) + " ").collect()
}

/// The `where` clause, with a space before it.
fn bounds(generics: &syn::Generics) -> String {
    generics
        .where_clause
        .as_ref()
        .map_or(String::new(), |clause| format!(" {}", line(clause).trim_end_matches(',')))
}

/// A function's signature with its path in place of its name, without patterns and `mut` in parameters.
fn signature(before: &str, signature: &Signature, path: &str) -> String {
    let mut plain = signature.clone();
    for input in &mut plain.inputs {
        match input {
            FnArg::Receiver(receiver) => receiver.mutability = None,
            FnArg::Typed(typed) => match &mut *typed.pat {
                Pat::Ident(ident) => ident.mutability = None,
                pattern => {
                    let underscore_token = Default::default();
                    *pattern = Pat::Wild(PatWild { attrs: Vec::new(), underscore_token });
                }
            },
        }
    }
    let text = line(&plain);
    let name = format!("fn {}", signature.ident);
    before.to_owned() + &text.replacen(&name, &format!("fn {path}"), 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn listed(text: &str) -> Vec<String> {
        let file = std::path::Path::new("lib.rs");
        let code = Crate::load(file, &|_| Some(text.to_owned())).expect("code that parses");
        lines(&code, "c")
    }

    #[test]
    fn only_what_is_reachable_is_listed() {
        let found = listed(
            "mod a { pub struct A { pub x: u8, y: u8 } impl A { pub fn f(&self) {} fn g() {} } pub fn hidden() {} }
             pub mod b { pub use crate::a::A as B; #[doc(hidden)] pub fn h() {} }
             pub use a::A; #[derive(Debug)] struct Private; impl ::core::clone::Clone for a::A {}
             impl a::A { pub fn f2(mut self, [x, y]: [u8; 2], mut z: u8) {} }",
        );
        let expected = [
            "impl Clone for c::A",
            "pub struct c::A { private fields }",
            "pub use c::A as c::b::B",
            "pub fn c::A::f(&self)",
            "pub fn c::A::f2(self, _: [u8; 2], z: u8)",
            "pub c::A::x: u8",
            "pub mod c::b",
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn variants_and_traits_are_listed() {
        let found = listed(
            "#[non_exhaustive] pub enum E<T> { A, B(T), C { x: u8 } }
             pub trait T: Clone { const N: usize; fn f(&self) -> u8; fn g() {} } impl T for u8 {} mod m { pub trait S {} }
             impl m::S for u8 {} impl m::S for E<u8> {}",
        );
        let expected = [
            "impl T for u8",
            "#[non_exhaustive] pub enum c::E<T>",
            "c::E::A",
            "c::E::B(T)",
            "c::E::C { x: u8 }",
            "pub trait c::T: Clone",
            "const c::T::N: usize",
            "fn c::T::f(&self) -> u8",
            "fn c::T::g() { provided }",
        ];
        assert_eq!(found, expected);
    }
}
