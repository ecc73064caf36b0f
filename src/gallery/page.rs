//! The page of a gallery: what was surveyed goes in, one HTML page comes out. Its pictures are files beside it.
//!
//! The page needs no script and no network. All that it says comes from files of strangers: every text is escaped.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::scene::{Param, ParamDomain};

use super::{Module, Painted, Parameter, Shown, Tone, import};

/// How it looks.
const STYLE: &str = include_str!("page.css");

/// What a page that this program wrote says of itself.
pub const GENERATOR: &str = "kake gallery";

/// What the page shows.
#[derive(Debug)]
pub struct Page<'a> {
    /// What stands on top.
    pub title: &'a str,
    /// A line about the whole.
    pub about: Option<&'a str>,
    /// The name under which other libraries import the files.
    pub library: Option<&'a str>,
    /// The contact sheet, from the page, where it lies beside it.
    pub sheet: Option<&'a str>,
    /// The files.
    pub modules: &'a [Module],
    /// The picture files from the page: for each module those of its tones one after the other, then its scene's. None where
    /// there is no picture.
    pub pictures: &'a [Vec<Option<String>>],
}

/// Writes the page.
#[must_use]
pub fn page(page: &Page<'_>) -> String {
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content=(GENERATOR);
                title { (page.title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                a.skip href="#main" { "To the tones" }
                header {
                    h1 { (page.title) }
                    @if let Some(about) = page.about { p.about { (about) } }
                    p.counts {
                        (counts(page.modules))
                        @if let Some(sheet) = page.sheet { " \u{b7} " a href=(href(sheet)) { "contact sheet" } }
                    }
                }
                div.columns {
                    (contents(page))
                    main id="main" tabindex="-1" {
                        @for (i, module) in page.modules.iter().enumerate() {
                            (section(page, i, module))
                        }
                    }
                }
            }
        }
    };
    markup.into_string()
}

/// A path as a link: what a link means otherwise is escaped.
fn href(path: &str) -> String {
    let mut link = String::new();
    for character in path.chars() {
        match character {
            '%' => link.push_str("%25"),
            '?' => link.push_str("%3f"),
            '#' => link.push_str("%23"),
            ' ' => link.push_str("%20"),
            other => link.push(other),
        }
    }
    link
}

fn counted(count: usize, one: &str, many: &str) -> Option<String> {
    match count {
        0 => None,
        1 => Some(format!("1 {one}")),
        count => Some(format!("{count} {many}")),
    }
}

fn counts(modules: &[Module]) -> String {
    let tones = modules.iter().map(|module| module.tones.len()).sum();
    let scenes = modules.iter().filter(|module| module.scene.is_some()).count();
    let broken = modules.iter().filter(|module| module.faults.is_some()).count();
    let parts = [
        counted(tones, "tone", "tones"),
        counted(scenes, "scene", "scenes"),
        counted(broken, "file at fault", "files at fault"),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// The name of a module or tone within the page.
fn anchor(module: usize, tone: Option<usize>) -> String {
    match tone {
        None => format!("file-{}", module + 1),
        Some(tone) => format!("file-{}-tone-{}", module + 1, tone + 1),
    }
}

fn contents(page: &Page<'_>) -> Markup {
    html! {
        nav aria-label="Contents" {
            ul {
                @for (i, module) in page.modules.iter().enumerate() {
                    li {
                        a href=(format!("#{}", anchor(i, None))) { (module.path) }
                        @if module.faults.is_some() { " " span.fault { "at fault" } }
                        @if !module.tones.is_empty() {
                            ul {
                                @for (j, tone) in module.tones.iter().enumerate() {
                                    li { a href=(format!("#{}", anchor(i, Some(j)))) { (tone.name) } }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn section(page: &Page<'_>, number: usize, module: &Module) -> Markup {
    let none = Vec::new();
    let pictures = page.pictures.get(number).unwrap_or(&none);
    let starts = module.tones.iter().scan(0, |next, tone| {
        let start = *next;
        *next += tone.swatches.len();
        Some(start)
    });
    let shown: usize = module.tones.iter().map(|tone| tone.swatches.len()).sum();
    let import = import(&module.path, page.library);
    html! {
        section id=(anchor(number, None)) {
            h2 { (module.path) }
            @if let Some(intro) = &module.intro { (prose(intro)) }
            @if let Some(faults) = &module.faults {
                p.fault { "This file is at fault, so that nothing of it can be drawn." }
                pre.faults { (faults) }
            }
            @if let Some(scene) = &module.scene {
                (painted(module, scene, pictures.get(shown).and_then(Option::as_ref)))
            }
            @for (j, (tone, start)) in module.tones.iter().zip(starts).enumerate() {
                (article(&anchor(number, Some(j)), tone, &import, pictures.get(start..).unwrap_or_default()))
            }
        }
    }
}

/// A doc comment: paragraphs, and code between backticks.
fn prose(text: &str) -> Markup {
    html! {
        @for paragraph in text.split("\n\n").map(str::trim).filter(|paragraph| !paragraph.is_empty()) {
            p { (inline(paragraph)) }
        }
    }
}

fn inline(text: &str) -> Markup {
    html! {
        @for (i, part) in text.split('`').enumerate() {
            @if i % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

fn article(id: &str, tone: &Tone, import: &str, pictures: &[Option<String>]) -> Markup {
    let call = tone.swatches.first().map_or(tone.name.as_str(), |shown| shown.call.as_str());
    html! {
        article id=(id) class=[(tone.swatches.len() == 1).then_some("single")] {
            div.says {
                h3 { a href=(format!("#{id}")) { (tone.name) } }
                @if let Some(doc) = &tone.doc { (prose(doc)) }
            }
            div.swatches {
                @for (i, shown) in tone.swatches.iter().enumerate() {
                    (swatch(tone, shown, pictures.get(i).and_then(Option::as_ref)))
                }
            }
            div.use {
                pre tabindex="0" { code { (import) "\n\npaint canvas with " (call) } }
                @if !tone.params.is_empty() { (params(&tone.params)) }
            }
        }
    }
}

fn swatch(tone: &Tone, shown: &Shown, picture: Option<&String>) -> Markup {
    html! {
        figure {
            @match (&shown.picture, picture) {
                (Ok(drawing), Some(file)) => {
                    a.paper href=(href(file)) {
                        img src=(href(file)) loading="lazy" alt=(alternative(tone, shown))
                            width=(format!("{:.0}", drawing.page.width.to_mm() * 10.0))
                            height=(format!("{:.0}", drawing.page.height.to_mm() * 10.0));
                    }
                }
                (Err(why), _) => div.paper.none { p { (why) } },
                (Ok(_), None) => div.paper.none { p { "the picture could not be written" } },
            }
            figcaption {
                @if !shown.label.is_empty() { (shown.label) " \u{b7} " }
                @if let Ok(drawing) = &shown.picture {
                    span.size { (format!("{:.0}\u{a0}mm\u{a0}wide", drawing.page.width.to_mm())) }
                }
            }
        }
    }
}

fn alternative(tone: &Tone, shown: &Shown) -> String {
    if shown.label.is_empty() { tone.name.clone() } else { format!("{}, {}", tone.name, shown.label) }
}

fn params(params: &[Parameter]) -> Markup {
    html! {
        table {
            thead { tr { th { "parameter" } th { "type" } th { "default" } } }
            tbody {
                @for param in params {
                    tr {
                        th scope="row" {
                            code { (param.name) }
                            @if let Some(doc) = &param.doc { span.doc { (inline(doc)) } }
                        }
                        td { (param.ty.as_deref().unwrap_or("\u{2013}")) }
                        td { @match &param.default { Some(default) => code { (default) }, None => span.size { "required" } } }
                    }
                }
            }
        }
    }
}

fn painted(module: &Module, scene: &Painted, picture: Option<&String>) -> Markup {
    html! {
        article.scene {
            figure {
                @match (&scene.picture, picture) {
                    (Ok(drawing), Some(file)) => {
                        a.paper href=(href(file)) {
                            img src=(href(file)) loading="lazy" alt=(module.path)
                                width=(format!("{:.0}", drawing.page.width.to_mm() * 10.0))
                                height=(format!("{:.0}", drawing.page.height.to_mm() * 10.0));
                        }
                        figcaption { span.size {
                            (format!("{:.0} \u{d7} {:.0} mm", drawing.page.width.to_mm(), drawing.page.height.to_mm()))
                        } }
                    }
                    (Err(why), _) => div.paper.none { p { (why) } },
                    (Ok(_), None) => div.paper.none { p { "the picture could not be written" } },
                }
            }
            div.use {
                pre tabindex="0" { code { "kake build " (module.path) } }
                @if !scene.params.is_empty() { (settable(&scene.params)) }
            }
        }
    }
}

fn settable(params: &[Param]) -> Markup {
    html! {
        table {
            thead { tr { th { "parameter" } th { "type" } th { "default" } th { "allowed" } } }
            tbody {
                @for param in params {
                    tr {
                        th scope="row" {
                            code { (param.name) }
                            @if let Some(doc) = &param.doc { span.doc { (inline(doc)) } }
                        }
                        td { (param.ty) }
                        td { code { (param.default.text) } }
                        td {
                            @match &param.domain {
                                Some(ParamDomain::Range(low, high)) => code { (low.text) " .. " (high.text) },
                                Some(ParamDomain::Choices(choices)) => {
                                    @for (i, choice) in choices.iter().enumerate() {
                                        @if i > 0 { ", " }
                                        code { (choice.text) }
                                    }
                                }
                                None => "",
                            }
                        }
                    }
                }
            }
        }
    }
}
