//! Scopes: the names that can be seen from a place, with values that are found when they are first asked for.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use crate::span::Span;
use crate::syntax::ast;

use super::value::Value;

/// Names around a place: a module's, a block's, or the parameters of a tone or function.
#[derive(Debug)]
pub(super) struct Scope<'a> {
    /// Which module the place belongs to.
    pub(super) module: usize,
    parent: Option<Rc<Self>>,
    names: RefCell<BTreeMap<&'a str, Entry<'a>>>,
}

/// A name with where it is declared.
#[derive(Debug, Clone)]
pub(super) struct Entry<'a> {
    pub(super) binding: Binding<'a>,
    pub(super) span: Span,
}

/// What a name stands for.
#[derive(Debug, Clone)]
pub(super) enum Binding<'a> {
    /// It is known.
    Value(Value),
    /// It is found when it is asked for.
    Lazy(&'a ast::Binding, Declared<'a>),
    /// It is being found: whoever asks for it now goes round in a circle.
    Busy,
}

/// By which statement a name is declared.
#[derive(Debug, Clone, Copy)]
pub(super) enum Declared<'a> {
    Let,
    Field,
    Region,
    /// With the range or choices it is held to.
    Param(Option<&'a ast::Expr>),
}

impl<'a> Scope<'a> {
    /// The scope of a module.
    pub(super) fn module(module: usize) -> Rc<Self> {
        Rc::new(Self { module, parent: None, names: RefCell::default() })
    }

    /// A scope inside another.
    pub(super) fn inside(parent: &Rc<Self>) -> Rc<Self> {
        Rc::new(Self { module: parent.module, parent: Some(Rc::clone(parent)), names: RefCell::default() })
    }

    /// Declares a name; the place of an earlier declaration where the scope has one already.
    pub(super) fn declare(&self, name: &'a str, binding: Binding<'a>, span: Span) -> Option<Span> {
        let mut names = self.names.borrow_mut();
        match names.get(name) {
            Some(earlier) => Some(earlier.span),
            None => {
                names.insert(name, Entry { binding, span });
                None
            }
        }
    }

    /// Replaces what a declared name stands for.
    pub(super) fn set(&self, name: &str, binding: Binding<'a>) {
        if let Some(entry) = self.names.borrow_mut().get_mut(name) {
            entry.binding = binding;
        }
    }

    /// What a name stands for in this scope alone.
    pub(super) fn own(&self, name: &str) -> Option<Entry<'a>> {
        self.names.borrow().get(name).cloned()
    }

    /// The scope around this one.
    pub(super) fn parent(&self) -> Option<&Rc<Self>> {
        self.parent.as_ref()
    }

    /// The names of this scope alone, in order.
    pub(super) fn own_names(&self) -> Vec<&'a str> {
        self.names.borrow().keys().copied().collect()
    }
}
