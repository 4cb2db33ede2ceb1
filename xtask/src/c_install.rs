//! `cargo xtask c-install`: the C library where compilers, pkg-config and CMake find it.

use std::env::consts::OS;
use std::fs;
use std::path::{Path, PathBuf};

/// Version of the library, and what its shared form is called.
pub struct Release {
    /// From the header, which a test holds to the crate's.
    pub version: String,
    /// Major and minor. Before 1.0.0 minor versions are not compatible with each other.
    series: [String; 2],
}

impl Release {
    /// Of the header in this repository.
    pub fn of(header: &str) -> Result<Self, String> {
        let version = header.lines().find_map(|line| line.strip_prefix("#define GRN_VERSION_STRING "));
        let version = version.ok_or("grn.h has no GRN_VERSION_STRING")?.trim_matches('"').to_owned();
        let mut parts = version.split('.').map(str::to_owned);
        let series = [parts.next().unwrap_or_default(), parts.next().unwrap_or_default()];
        Ok(Release { version, series })
    }

    /// The name that a program asks for when it starts.
    pub fn soname(&self) -> String {
        match &self.series {
            [major, minor] if major == "0" => format!("libgrn.so.0.{minor}"),
            [major, _] => format!("libgrn.so.{major}"),
        }
    }

    /// The name of the shared library's file.
    fn file(&self) -> String {
        format!("libgrn.so.{}", self.version)
    }

    fn filled_in(&self, template: &str) -> String {
        let [major, minor] = &self.series;
        let (soname, pointer_bytes) = (self.soname(), size_of::<usize>().to_string());
        let values = [
            ("@VERSION@", &self.version),
            ("@MAJOR@", major),
            ("@MINOR@", minor),
            ("@SONAME@", &soname),
            ("@POINTER_BYTES@", &pointer_bytes),
        ];
        values.iter().fold(template.to_owned(), |text, (name, value)| text.replace(name, value))
    }
}

/// Builds the library and puts header, both libraries, pkg-config file and CMake package under `prefix`; says what it wrote.
pub fn install(prefix: &Path) -> Result<Vec<PathBuf>, String> {
    if OS != "linux" {
        return Err(format!(
            "the shared library is built for Linux only, this is {OS}: build the static one as firmware/README.md says"
        ));
    }
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let header = read(&repository.join("firmware/c/include/grn.h"))?;
    let release = Release::of(&String::from_utf8_lossy(&header))?;
    let static_library = build(&repository, "staticlib", "libgrn_c.a", &[])?;
    let soname = format!("-Clink-arg=-Wl,-soname,{}", release.soname());
    let shared_library = build(&repository, "cdylib", "libgrn_c.so", &[&soname, "-Cstrip=symbols"])?;
    let c = repository.join("firmware/c");
    let mut written = Vec::new();
    let mut put = |place: &str, content: Vec<u8>| {
        let path = prefix.join(place);
        replace(&path, &content).map(|()| written.push(path))
    };
    put("include/grn.h", header)?;
    put("lib/libgrn.a", read(&static_library)?)?;
    put(&format!("lib/{}", release.file()), read(&shared_library)?)?;
    let templates = [
        ("grn.pc.in", "lib/pkgconfig/grn.pc"),
        ("grn-config.cmake.in", "lib/cmake/grn/grn-config.cmake"),
        ("grn-config-version.cmake.in", "lib/cmake/grn/grn-config-version.cmake"),
    ];
    for (template, place) in templates {
        let text = read(&c.join("package").join(template))?;
        let text = String::from_utf8(text).map_err(|error| format!("{template}: {error}"))?;
        put(place, release.filled_in(&text).into_bytes())?;
    }
    for (link, to) in [(release.soname(), release.file()), ("libgrn.so".into(), release.soname())] {
        let path = prefix.join("lib").join(link);
        symlink(&to, &path)?;
        written.push(path);
    }
    Ok(written)
}

/// Builds the library as one sort of crate; the file that cargo leaves.
fn build(repository: &Path, sort: &str, file: &str, flags: &[&str]) -> Result<PathBuf, String> {
    let target = repository.join("firmware/target");
    let mut command = crate::this_cargo();
    command.args(["rustc", "--release", "--locked", "--manifest-path"]).arg(repository.join("firmware/Cargo.toml"));
    command
        .args(["--package", "grn-c", "--lib", "--crate-type", sort, "--target-dir"])
        .arg(&target)
        .arg("--")
        .args(flags);
    let status = command.status().map_err(|error| format!("cargo cannot be run: {error}"))?;
    if !status.success() {
        return Err(format!("the C library cannot be built as a {sort}"));
    }
    Ok(target.join("release").join(file))
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes a file under another name, then gives it its own: programs that use the old one keep it.
fn replace(path: &Path, content: &[u8]) -> Result<(), String> {
    let new = path.with_extension("new");
    let folder = path.parent().unwrap_or(path);
    let written =
        fs::create_dir_all(folder).and_then(|()| fs::write(&new, content)).and_then(|()| fs::rename(&new, path));
    written.map_err(|error| {
        format!("{}: {error}; choose a PREFIX that can be written, or run this as root", path.display())
    })
}

#[cfg(unix)]
fn symlink(to: &str, path: &Path) -> Result<(), String> {
    let new = path.with_extension("new");
    // It is there only if an installation was broken off.
    let _ = fs::remove_file(&new);
    let made = std::os::unix::fs::symlink(to, &new).and_then(|()| fs::rename(&new, path));
    made.map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(not(unix))]
fn symlink(_: &str, path: &Path) -> Result<(), String> {
    Err(format!("{}: this system has no links of this sort", path.display()))
}
