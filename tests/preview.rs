//! The page of `kake preview` in a real browser: the tests do what an artist does.
//!
//! Without a browser they say so and pass; with `KAKE_BROWSER=required` they fail. Nothing here measures time: what is waited
//! for has a deadline that only a fault reaches.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use headless_chrome::browser::tab::ModifierKey;

use crate::browser::{DEADLINE, Page, Server};

const SCENE: &str = r#"edition 1

canvas { size: (40mm, 30mm) }
seed 5

/// Side of a tile
param tile: length = 4mm in 2mm .. 8mm
/// How the <b>tiles</b> are turned
param rule = "bfs" in ["bfs", "random"]

tone plain {
  place: poisson(radius: tile / 1.6)
  shape: rect(size: tile)
  angle: match rule { "bfs" => bfs(), "random" => random() }
  fill: lines(pitch: 0.8mm, pen: 0.2mm)
}

region sheet = rect(at: (4mm, 4mm), size: (32mm, 22mm))
paint sheet with plain as "sheet"
outline sheet pen 0.4mm
"#;

/// Opens the page; nothing where there is no browser and none is required.
#[allow(clippy::print_stderr)]
fn open(server: &Server) -> Option<Page> {
    let page = Page::open(&server.address, server.path("profile"));
    let is_required = env::var("KAKE_BROWSER").is_ok_and(|value| value == "required");
    assert!(page.is_some() || !is_required, "no browser: `KAKE_CHROMIUM` names none, and the path has none");
    if page.is_none() {
        eprintln!("no Chromium is here: the page is not tried");
    }
    page
}

impl Server {
    fn scene(&self) -> String {
        fs::read_to_string(self.path("scene.kake")).expect("the scene can be read")
    }

    fn write(&self, scene: &str) {
        fs::write(self.path("scene.kake"), scene).expect("the scene can be written");
    }
}

impl Page {
    /// Clicks on an element, as the mouse does.
    fn click(&self, selector: &str) {
        self.ask(&format!("document.querySelector({selector:?}).scrollIntoView({{ block: 'nearest' }})"));
        self.tab.find_element(selector).and_then(|element| element.click().map(|_| ())).expect(selector);
    }

    fn key(&self, key: &str) {
        self.tab.press_key(key).expect("keys can be pressed");
    }

    fn key_with(&self, modifier: ModifierKey, key: &str) {
        self.tab.press_key_with_modifiers(key, Some(&[modifier])).expect("keys can be pressed");
    }

    fn command(&self) -> String {
        self.ask("document.querySelector('#command-text').textContent")
    }

    /// Waits until the command line has a word.
    fn until_command(&self, word: &str) {
        let has = format!("document.querySelector('#command-text').textContent.includes({word:?})");
        self.until(&format!("the command line has {word}"), &has);
    }

    /// What the screen shows where the picture is, to be compared: its pixels in 200 by 150.
    fn picture(&self) -> String {
        self.ask(
            "await (async () => {
                const image = document.querySelector('#sheet .whole img');
                const canvas = document.createElement('canvas');
                [canvas.width, canvas.height] = [200, 150];
                const context = canvas.getContext('2d');
                context.drawImage(image, 0, 0, 200, 150);
                const { data } = context.getImageData(0, 0, 200, 150);
                return [...new Uint8Array(await crypto.subtle.digest('SHA-256', data))].join();
            })()",
        )
    }

    /// Waits until the picture is another one, and gives it.
    fn until_other_picture(&self, what: &str, old: &str) -> String {
        let begun = Instant::now();
        loop {
            let picture = self.picture();
            if picture != old {
                return picture;
            }
            assert!(
                begun.elapsed() < DEADLINE,
                "the picture never changes: {what}\n{}",
                self.ask("document.body.innerText")
            );
            sleep(Duration::from_millis(20));
        }
    }

    /// The share of the picture's pixels that are dark.
    fn ink(&self) -> f64 {
        let ink = self.ask(
            "(() => {
                const canvas = document.createElement('canvas');
                [canvas.width, canvas.height] = [200, 150];
                const context = canvas.getContext('2d');
                context.drawImage(document.querySelector('#sheet .whole img'), 0, 0, 200, 150);
                const { data } = context.getImageData(0, 0, 200, 150);
                let dark = 0;
                for (let i = 0; i < data.length; i += 4) dark += data[i] < 128 ? 1 : 0;
                return dark / 30000;
            })()",
        );
        ink.parse().expect("a share is a number")
    }

    /// Waits for a message that begins with this, and gives what follows in it.
    fn message(&self, begin: &str) -> String {
        let find = format!(
            "[...document.querySelectorAll('.toast span')].findLast((e) => e.textContent.startsWith({begin:?}))"
        );
        self.until(&format!("a message says `{begin}`"), &format!("{find} !== undefined"));
        self.ask(&format!("{find}.textContent")).trim_start_matches(begin).to_owned()
    }

    /// Nothing was wrong, and nothing was asked of anyone but the server.
    fn is_clean(&self, address: &str) {
        assert_eq!(*self.errors.lock().unwrap(), Vec::<String>::new(), "errors on the console");
        let requests = self.requests.lock().unwrap();
        let own = [address, "blob:", "data:"];
        let foreign: Vec<&String> = requests.iter().filter(|url| !own.iter().any(|own| url.starts_with(own))).collect();
        assert!(foreign.is_empty(), "requests to others: {foreign:?}");
        assert!(requests.len() > 10, "the browser says what it asks for");
    }
}

/// Runs the command line that the page shows, into another file, and gives what it writes.
fn built(folder: &Path, command: &str) -> Vec<u8> {
    let words: Vec<&str> = command.split(' ').collect();
    assert_eq!(words[0], "kake");
    assert_eq!(words[words.len() - 2..], ["-o", "scene.svg"]);
    let done = Command::new(env!("CARGO_BIN_EXE_kake"))
        .args(&words[1..words.len() - 1])
        .arg("again.svg")
        .current_dir(folder)
        .status()
        .expect("the program starts");
    assert!(done.success());
    fs::read(folder.join("again.svg")).expect("the picture is written")
}

#[test]
fn a_scene_is_edited_turned_broken_mended_and_saved() {
    let server = Server::start(SCENE);
    let Some(page) = open(&server) else { return };
    let ink = page.ink();
    assert!((0.05..0.6).contains(&ink), "the picture has strokes, not {ink} of ink");
    let first = page.picture();

    // A scene's words are words, whatever they look like.
    let doc = "document.querySelector('[data-param=rule] .doc').textContent";
    assert_eq!(page.ask(doc), "How the <b>tiles</b> are turned");

    // The file is saved by an editor.
    server.write(&SCENE.replace("pitch: 0.8mm", "pitch: 0.5mm"));
    let edited = page.until_other_picture("the file was edited", &first);
    assert!(page.ink() > ink);

    // A slider, by its own key.
    page.ask("document.querySelector('[data-param=tile] input[type=range]').focus()");
    page.key("ArrowRight");
    page.until_command("--set tile=4.05mm");
    let moved = page.until_other_picture("the slider was moved", &edited);
    assert_eq!(page.ask("document.querySelector('[data-param=tile] .box').value"), "4.05");

    // A choice, and back again.
    page.click("[data-param=rule] input[value=random]");
    page.until_command("--set rule=random");
    page.until_other_picture("the choice was made", &moved);
    page.key_with(ModifierKey::Ctrl, "z");
    page.until("undone", "!document.querySelector('#command-text').textContent.includes('rule')");
    page.until("enabled", "!document.querySelector('#redo').disabled");
    assert_eq!(page.picture(), moved);

    // A layer and an overlay.
    page.click("[data-layer=outline]");
    let bare = page.until_other_picture("the outline was hidden", &moved);
    page.click("[data-layer=outline]");
    assert_eq!(page.until_other_picture("the outline was shown", &bare), moved);
    page.click("[data-overlay=angles]");
    page.until_command("--overlay angles");
    let angles = page.until_other_picture("the angles were shown", &moved);
    page.until("the picture is the last", "document.querySelector('#state').dataset.kind === 'ready'");
    assert_eq!(page.ask("document.querySelectorAll('#layers [data-layer]').length"), "2", "overlays are no layers");
    page.click("[data-overlay=angles]");
    assert_eq!(page.until_other_picture("the angles were hidden", &angles), moved);

    // The scene is broken, and the picture stays.
    let good = server.scene();
    server.write(&good.replace("rect(size: tile)", "rekt(size: tile)"));
    page.until("the picture is marked as old", "document.querySelector('#viewport').hasAttribute('data-old')");
    page.until("the mistake is shown", "document.querySelector('.code .problem') !== null");
    let line = good.lines().position(|line| line.contains("rect(size: tile)")).expect("the line is there") + 1;
    let problem = "document.querySelector('.code .problem')";
    assert_eq!(page.ask(&format!("{problem}.previousElementSibling.dataset.line")), line.to_string());
    assert_eq!(page.ask("document.querySelector('.code [data-mark=error]').textContent"), "rekt");
    assert_eq!(page.ask(&format!("{problem}.querySelector('.hint').textContent")), "did you mean `rect`?");
    assert_eq!(page.picture(), moved);
    assert_eq!(page.ask("document.querySelector('#banner').hidden"), "false");

    // It is mended.
    server.write(&good);
    page.until("the picture is new", "!document.querySelector('#viewport').hasAttribute('data-old')");
    page.until("the source is closed again", "document.querySelector('#drawer').hidden");
    assert_eq!(page.picture(), moved);

    // The picture is saved: the very bytes of the command line that is shown.
    page.click("[data-save=svg]");
    let saved = PathBuf::from(page.message("Saved "));
    assert_eq!(saved.canonicalize().unwrap(), server.path("scene.svg").canonicalize().unwrap());
    assert!(fs::read(&saved).unwrap() == built(server.folder.path(), &page.command()), "saved and built files differ");
    page.is_clean(&server.address);
}

#[test]
fn one_of_sixteen_is_chosen_and_written_into_the_scene() {
    let server = Server::start(SCENE);
    let Some(page) = open(&server) else { return };
    let first = page.picture();
    page.click("#vary");
    page.until("sixteen pictures", "document.querySelectorAll('.cell[data-state=there] img').length === 16");
    assert_eq!(page.ask("document.querySelector('.cell[aria-current]').textContent"), "seed 5");
    page.click(".cell:nth-child(6)");
    page.until_command("--seed 10");
    let chosen = page.until_other_picture("a variation was chosen", &first);

    page.click("#undo");
    page.until("undone", "!document.querySelector('#command-text').textContent.includes('--seed')");
    assert_eq!(page.until_other_picture("undone", &chosen), first);
    page.click("#redo");
    page.until_command("--seed 10");
    assert_eq!(page.until_other_picture("redone", &first), chosen);

    // A value that is none is told beside its box, and the picture stays.
    let tile = "[data-param=tile] .box";
    page.ask(&format!("(document.querySelector('{tile}').focus(), document.querySelector('{tile}').select())"));
    page.tab.type_str("12 mm").expect("text can be typed");
    page.key("Enter");
    page.until("the value is refused", "document.querySelector('[data-param=tile] .fault')?.hidden === false");
    assert!(page.ask("document.querySelector('[data-param=tile] .fault').textContent").contains("12mm"));
    assert_eq!(page.ask(&format!("document.querySelector('{tile}').value")), "12 mm", "it stays as it was typed");
    assert_eq!(page.picture(), chosen);
    // The command line is still that of the picture.
    assert_eq!(page.command(), "kake build scene.kake --seed 10 -o scene.svg");
    // A space before the unit is no mistake.
    page.ask(&format!("document.querySelector('{tile}').select()"));
    page.tab.type_str("6 mm").expect("text can be typed");
    page.key("Enter");
    page.until_command("--set tile=6mm");
    assert_eq!(page.ask(&format!("document.querySelector('{tile}').value")), "6");
    let wide = page.until_other_picture("a value was typed", &chosen);

    // The link holds it all.
    let link = format!("{}#set.tile=6mm&seed=10", server.address);
    page.until("the address has the values", "location.hash !== ''");
    page.until("the address has all values", &format!("location.href === {link:?}"));

    // The scene takes over what was found.
    page.until("good", "document.querySelector('#write').disabled === false");
    page.click("#write");
    page.message("Written into scene.kake");
    let scene = server.scene();
    assert!(scene.contains("param tile: length = 6mm in 2mm .. 8mm") && scene.contains("seed 10"), "{scene}");
    page.until(
        "nothing is set",
        "document.querySelector('#command-text').textContent === 'kake build scene.kake -o scene.svg'",
    );
    assert_eq!(page.picture(), wide);
    page.is_clean(&server.address);
}

#[test]
fn the_keyboard_is_enough() {
    let server = Server::start(SCENE);
    let Some(page) = open(&server) else { return };
    page.key("?");
    page.until("the keys are listed", "document.querySelector('#help').open");
    page.key("Escape");
    page.until("the list is closed", "!document.querySelector('#help').open");

    // From stop to stop as far as the slider.
    let is_slider = "document.activeElement.matches('[data-param=tile] input[type=range]')";
    for _ in 0..60 {
        if page.ask(is_slider) == "true" {
            break;
        }
        page.key("Tab");
    }
    assert_eq!(page.ask(is_slider), "true", "the slider is reached");
    assert_ne!(page.ask("getComputedStyle(document.activeElement).outlineStyle"), "none", "the focus is seen");
    let first = page.picture();
    page.key("End");
    page.until_command("--set tile=8mm");
    let wide = page.until_other_picture("the slider is at its end", &first);

    // Variations, the second row's second picture.
    page.key("v");
    page.until("sixteen pictures", "document.querySelectorAll('.cell[data-state=there]').length === 16");
    page.key("ArrowRight");
    page.key("ArrowDown");
    page.key("Enter");
    page.until_command("--seed 10");
    page.until_other_picture("a variation was chosen", &wide);
    page.key("[");
    page.until_command("--seed 9");

    // What is no seed is told below the box, once, and stays in it.
    page.ask("(document.querySelector('#seed').focus(), document.querySelector('#seed').select())");
    page.tab.type_str("-4").expect("text can be typed");
    page.key("Enter");
    page.key("Enter");
    page.until("the seed is refused", "!document.querySelector('#seed-fault').hidden");
    assert_eq!(page.ask("document.querySelectorAll('.toast').length"), "0");
    assert_eq!(page.ask("document.querySelector('#seed').value"), "-4");
    page.key("Escape");
    page.until("the seed is back", "document.querySelector('#seed').value === '9'");
    assert_eq!(page.ask("document.querySelector('#seed-fault').hidden"), "true");
    page.ask("document.activeElement.blur()");

    // Zoom, measures, source, and the picture into a file.
    let scale = page.ask("document.querySelector('#zoom-text').textContent");
    page.key("1");
    page.until("the page is as large as on paper", "document.querySelector('#zoom-text').textContent === '100 %'");
    page.key("f");
    page.until("the page fits", &format!("document.querySelector('#zoom-text').textContent === {scale:?}"));
    page.key("m");
    page.until("the figures are there", "document.querySelector('.measures .value')?.textContent > 0");
    page.until("the correlogram is there", "document.querySelector('.chart .correlogram circle') !== null");
    page.until("the charts are there", "document.querySelector('.chart img')?.naturalWidth > 0");
    page.key("s");
    page.until("the source is there", "document.querySelectorAll('.code .line').length > 10");
    page.key_with(ModifierKey::Ctrl, "s");
    page.message("Saved ");
    assert!(server.path("scene.svg").is_file());
    page.is_clean(&server.address);
}

#[test]
fn tiles_show_a_large_drawing() {
    // The strokes of this are more than one SVG is shown for.
    let scene = SCENE.replace("(40mm, 30mm)", "(400mm, 300mm)").replace("(32mm, 22mm)", "(392mm, 292mm)");
    let scene = scene.replace("= 4mm in", "= 2.5mm in").replace("pitch: 0.8mm", "pitch: 0.4mm");
    let server = Server::start(&scene);
    let Some(page) = open(&server) else { return };
    let tiles = "document.querySelectorAll('#sheet .tiles img')";
    assert_ne!(page.ask(&format!("{tiles}.length")), "0", "tiles are shown");
    page.until("the tiles are there", &format!("[...{tiles}].every((tile) => tile.naturalWidth > 0)"));
    let level = |page: &Page| page.ask(&format!("new URL({tiles}[0].src).pathname.split('/')[5]"));
    let coarse: i32 = level(&page).parse().expect("levels are numbers");
    for _ in 0..8 {
        page.key("+");
    }
    // The finer level comes over the coarser one, which then goes.
    let finer = format!("[...{tiles}].every((tile) => new URL(tile.src).pathname.split('/')[5] > {coarse})");
    page.until("only the finer level is left", &finer);
    page.is_clean(&server.address);
}

#[test]
fn the_page_waits_for_its_server() {
    let mut server = Server::start(SCENE);
    let Some(page) = open(&server) else { return };
    let picture = page.picture();
    server.child.kill().and_then(|()| server.child.wait()).expect("the program can be ended");
    page.until("the page says so", "document.querySelector('#state').dataset.kind === 'gone'");
    assert_eq!(page.picture(), picture);
    assert_eq!(page.ask("document.querySelector('#banner').hidden"), "false");
    // A new server on the same port has a token of its own: the page takes it and goes on where it was.
    let port = server.address.trim_end_matches('/').rsplit(':').next().expect("the address has a port").to_owned();
    server.child = Command::new(env!("CARGO_BIN_EXE_kake"))
        .args(["preview", "scene.kake", "--port", &port])
        .current_dir(server.folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    page.until("the page is back", "document.querySelector('#state')?.dataset.kind === 'ready'");
    page.until("the banner is gone", "document.querySelector('#banner').hidden");
    assert_eq!(page.picture(), picture);
}

#[test]
fn a_fitted_page_lies_under_nothing() {
    let scene = SCENE.replace("(40mm, 30mm)", "(40mm, 60mm)");
    let server = Server::start(&scene);
    let Some(page) = open(&server) else { return };
    let gap = |above: &str, below: &str| {
        let edge =
            |selector: &str, side: &str| format!("document.querySelector('{selector}').getBoundingClientRect().{side}");
        format!("{} <= {}", edge(above, "bottom"), edge(below, "top"))
    };
    page.until("the scale bar lies below the page", &gap("#sheet", "#rule"));
    server.write(&scene.replace("rect(size: tile)", "rekt(size: tile)"));
    page.until("the mistake is told", "!document.querySelector('#banner').hidden");
    page.until("the banner lies above the page", &gap("#banner", "#sheet"));
    page.until("the scale bar lies below the page still", &gap("#sheet", "#rule"));
}

#[test]
fn before_the_first_picture_nothing_is_there_to_be_turned() {
    let server = Server::start(SCENE);
    let Some(page) = open(&server) else { return };
    server.write(&SCENE.replace("rect(size: tile)", "rekt(size: tile)"));
    page.until("the mistake is told", "!document.querySelector('#banner').hidden");
    page.ask("location.reload()");
    page.until(
        "the page has no picture",
        "document.body?.dataset.state === 'empty' && document.querySelector('#state').dataset.kind === 'faulty'",
    );
    let seen = "['#rule', '#zoom-in', '#seed', '#overlays', '#layers'].filter((name) => \
                document.querySelector(name).getClientRects().length > 0)";
    assert_eq!(page.ask(&format!("{seen}.join()")), "");
    assert_eq!(page.ask("document.querySelector('[data-save=svg]').disabled"), "true");
    server.write(SCENE);
    page.until("the picture is there", "document.body.dataset.state === 'drawn'");
    assert_eq!(page.ask(&format!("{seen}.length")), "5");
    page.until("it can be saved", "!document.querySelector('[data-save=svg]').disabled");
}
