//! The installed C library as its users find it: by pkg-config and by CMake, in C and in C++, shared and static.

use crate::c_install::{self, Release};
use crate::target::tools;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What has to be installed for these tests, and the Debian packages that have it.
const TOOLS: [(&str, &[&str]); 5] = [
    ("cc", &["gcc", "libc6-dev"]),
    ("c++", &["g++"]),
    ("readelf", &["binutils"]),
    ("pkg-config", &["pkg-config"]),
    ("cmake", &["cmake", "make"]),
];
const WARNINGS: [&str; 5] = ["-O2", "-pedantic", "-Wall", "-Wextra", "-Werror"];

/// An installation in a folder of its own, which is removed in the end.
struct Package {
    folder: PathBuf,
    prefix: PathBuf,
    repository: PathBuf,
}

impl Drop for Package {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Installs the library into a temporary folder and uses it in every way.
pub fn checks() -> Vec<(&'static str, Result<(), String>)> {
    let package = match tools::programs(&TOOLS).and_then(|()| Package::install()) {
        Ok(package) => package,
        Err(error) => return vec![("the library can be installed", Err(error))],
    };
    vec![
        ("the shared library exports what the header declares, under its soname", package.exports()),
        ("a static library alone makes no shared one, but whole it does", package.whole_archive()),
        ("the empty percept compiles without warnings in C99, C11 and C++11", package.strict()),
        ("pkg-config finds the shared library for C", package.with_pkg_config("cc", "first.c", Linking::Shared)),
        ("pkg-config finds the shared library for C++", package.with_pkg_config("c++", "first.cpp", Linking::Shared)),
        ("pkg-config finds the static library for C", package.with_pkg_config("cc", "first.c", Linking::Archive)),
        ("pkg-config finds the static library for C++", package.with_pkg_config("c++", "first.cpp", Linking::Archive)),
        ("a program without any shared library links", package.with_pkg_config("cc", "first.c", Linking::Static)),
        ("CMake finds both libraries for C and C++", package.with_cmake()),
        ("CMake refuses other versions", package.other_versions()),
        ("the controller for Webots compiles", package.controller("webots")),
        ("the controller for ARGoS compiles", package.controller("argos")),
    ]
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Linking {
    /// With libgrn.so.
    Shared,
    /// With libgrn.a, and the system's shared libraries.
    Archive,
    /// With no shared library at all.
    Static,
}

impl Package {
    fn install() -> Result<Self, String> {
        let folder = std::env::temp_dir().join(format!("grn-package-{}", std::process::id()));
        let prefix = folder.join("a prefix");
        let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let package = Package { folder, prefix, repository };
        c_install::install(&package.prefix)?;
        // Once more, over itself.
        let written = c_install::install(&package.prefix)?;
        match written.iter().find(|path| !path.exists()) {
            None => Ok(package),
            Some(missing) => Err(format!("{} is not there", missing.display())),
        }
    }

    fn example(&self, name: &str) -> PathBuf {
        self.repository.join("firmware/examples/c/package").join(name)
    }

    fn model(&self) -> PathBuf {
        self.repository.join("models/nand-xnor.grn")
    }

    fn header(&self) -> Result<String, String> {
        let path = self.prefix.join("include/grn.h");
        fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// The functions that a library exports, sorted.
    fn functions(&self, library: &Path) -> Result<Vec<String>, String> {
        let symbols = printed(Command::new("readelf").args(["--dyn-syms", "--wide"]).arg(library))?;
        let defined = symbols.lines().filter(|line| line.contains(" GLOBAL ") && !line.contains(" UND "));
        let mut names: Vec<String> =
            defined.filter_map(|line| line.split_whitespace().last()).map(str::to_owned).collect();
        names.sort();
        Ok(names)
    }

    fn exports(&self) -> Result<(), String> {
        let header = self.header()?;
        let library = self.prefix.join("lib/libgrn.so");
        let code = header.lines().filter(|line| !line.trim_start().starts_with("//"));
        let name = |line: &str| line.split_once("grn_")?.1.split_once('(').map(|(name, _)| format!("grn_{name}"));
        let mut declared: Vec<String> = code.filter_map(name).collect();
        declared.sort();
        let exported = self.functions(&library)?;
        if exported != declared {
            return Err(format!("the library exports {exported:?}, the header declares {declared:?}"));
        }
        let dynamic = printed(Command::new("readelf").args(["--dynamic", "--wide"]).arg(&library))?;
        let soname = format!("[{}]", Release::of(&header)?.soname());
        let named = dynamic.lines().any(|line| line.contains("(SONAME)") && line.contains(&soname));
        if named { Ok(()) } else { Err(format!("the soname is not {soname}: {dynamic}")) }
    }

    /// What docs say about making a shared library oneself.
    fn whole_archive(&self) -> Result<(), String> {
        let archive = self.prefix.join("lib/libgrn.a");
        let shared = |flags: [&str; 2]| {
            let library = self.folder.join("own.so");
            printed(Command::new("cc").args(["-shared", flags[0]]).arg(&archive).args([flags[1], "-o"]).arg(&library))?;
            self.functions(&library)
        };
        let (alone, whole) = (shared(["-O2", "-O2"])?, shared(["-Wl,--whole-archive", "-Wl,--no-whole-archive"])?);
        match whole.iter().any(|name| name == "grn_tick") {
            true if !alone.iter().any(|name| name.starts_with("grn_")) => Ok(()),
            _ => Err(format!("alone it exports {alone:?}, whole {whole:?}")),
        }
    }

    fn strict(&self) -> Result<(), String> {
        let include = format!("-I{}", self.prefix.join("include").display());
        [("cc", "c", "c99"), ("cc", "c", "c11"), ("c++", "c++", "c++11"), ("c++", "c++", "c++17")].iter().try_for_each(
            |(compiler, language, standard)| {
                let mut command = Command::new(compiler);
                command.args([
                    "-x",
                    language,
                    &format!("-std={standard}"),
                    "-fsyntax-only",
                    "-Wmissing-field-initializers",
                ]);
                printed(command.args(WARNINGS).arg(&include).arg(self.example("first.c"))).map(drop)
            },
        )
    }

    /// Compiles the example as its first lines say, and runs it.
    fn with_pkg_config(&self, compiler: &str, source: &str, linking: Linking) -> Result<(), String> {
        let asked: &[&str] = match linking {
            Linking::Shared => &["--cflags", "--libs"],
            Linking::Archive => &["--cflags"],
            Linking::Static => &["--static", "--cflags", "--libs"],
        };
        let mut flags = self.pkg_config(asked)?;
        match linking {
            Linking::Shared => flags.push(format!("-Wl,-rpath,{}", self.prefix.join("lib").display())),
            Linking::Archive => flags.extend(self.pkg_config(&["--variable=staticlib"])?),
            Linking::Static => flags.push("-static".into()),
        }
        let program = self.folder.join(format!("{source}-{}", linking as u8));
        printed(Command::new(compiler).args(WARNINGS).arg(self.example(source)).args(&flags).arg("-o").arg(&program))?;
        self.runs(&program, linking)
    }

    fn pkg_config(&self, asked: &[&str]) -> Result<Vec<String>, String> {
        let mut command = Command::new("pkg-config");
        command.env("PKG_CONFIG_PATH", self.prefix.join("lib/pkgconfig")).args(asked).arg("grn");
        let output = printed(&mut command)?;
        // A space in a path is written "\\ ".
        let flags = output.trim().replace("\\ ", "\0");
        Ok(flags.split_whitespace().map(|flag| flag.replace('\0', " ")).collect())
    }

    /// Runs a program and looks which libraries it takes.
    fn runs(&self, program: &Path, linking: Linking) -> Result<(), String> {
        let output = printed(Command::new(program).arg(self.model()))?;
        let version = Release::of(&self.header()?)?.version;
        if !output.starts_with(&format!("grn {version}: wheels "))
            || !output.ends_with(", 4 messages, nothing is nothing: 1\n")
        {
            return Err(format!("{} prints {output:?}", program.display()));
        }
        let dynamic = printed(Command::new("readelf").args(["--dynamic", "--wide"]).arg(program))?;
        let shared = dynamic.lines().any(|line| line.contains("(NEEDED)") && line.contains("libgrn.so"));
        if shared == (linking == Linking::Shared) {
            Ok(())
        } else {
            Err(format!("it takes the wrong library: {dynamic}"))
        }
    }

    fn cmake(&self, project: &Path, build: &str) -> Command {
        let mut command = Command::new("cmake");
        command.arg("-S").arg(project).arg("-B").arg(self.folder.join(build));
        command.arg(format!("-DCMAKE_PREFIX_PATH={}", self.prefix.display()));
        command
    }

    fn with_cmake(&self) -> Result<(), String> {
        printed(&mut self.cmake(&self.example(""), "build"))?;
        printed(Command::new("cmake").arg("--build").arg(self.folder.join("build")))?;
        let programs =
            [("c", Linking::Shared), ("c", Linking::Archive), ("cpp", Linking::Shared), ("cpp", Linking::Archive)];
        programs.iter().try_for_each(|&(language, linking)| {
            let library = if linking == Linking::Shared { "shared" } else { "static" };
            self.runs(&self.folder.join(format!("build/first-{language}-{library}")), linking)
        })
    }

    /// Compiles a simulator's controller against the installed package, and declarations in the simulator's place.
    fn controller(&self, simulator: &str) -> Result<(), String> {
        let project = self.repository.join("examples").join(simulator).join("controllers/grn");
        let build = format!("build {simulator}");
        let mut configure = self.cmake(&project, &build);
        configure.arg(format!("-D{}_STUBS=ON", simulator.to_uppercase()));
        configure.arg("-DCMAKE_C_FLAGS=-Wall -Wextra -Werror").arg("-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror");
        printed(&mut configure)?;
        printed(Command::new("cmake").arg("--build").arg(self.folder.join(&build))).map(drop)
    }

    fn other_versions(&self) -> Result<(), String> {
        let version = Release::of(&self.header()?)?.version;
        let cases = [
            (version.as_str(), true),
            ("0.2", true),
            ("0.2.99", false),
            ("0.1", false),
            ("0.0.1", false),
            ("1", false),
        ];
        cases.iter().try_for_each(|&(asked, accepted)| {
            let project = self.folder.join(format!("asks for {asked}"));
            let text = format!(
                "cmake_minimum_required(VERSION 3.13)\nproject(asks LANGUAGES C)\nfind_package(grn {asked} REQUIRED)\n"
            );
            fs::create_dir_all(&project)
                .and_then(|()| fs::write(project.join("CMakeLists.txt"), text))
                .map_err(|error| format!("{}: {error}", project.display()))?;
            let found = self.cmake(&project, &format!("build {asked}")).output();
            let found = found.map_err(|error| format!("cmake: {error}"))?.status.success();
            if found == accepted { Ok(()) } else { Err(format!("version {asked}: found is {found}")) }
        })
    }
}

/// What a command printed that must succeed.
fn printed(command: &mut Command) -> Result<String, String> {
    let described = format!("{command:?}");
    let output = command.output().map_err(|error| format!("{described}: {error}"))?;
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(said);
    }
    Err(format!("{described}: {}\n{said}{}", output.status, String::from_utf8_lossy(&output.stderr)))
}
