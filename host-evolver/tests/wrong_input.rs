//! Every wrong number, name, file and option is refused before any work: exit code 2, no panic, no folder made, and a first
//! line that says where, what, why and what to do.

mod support;

use support::Outcome;
use support::desk::{CAMPAIGN, Desk, WORLD, edited};

/// All cases that are not as they should be.
fn assert_all(cases: impl Iterator<Item = Outcome>) {
    let wrong: Vec<String> = cases.filter_map(Result::err).map(|error| error.to_string()).collect();
    assert!(wrong.is_empty(), "{} cases:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn wrong_worlds() -> Outcome {
    let many_points = vec!["[3.0, 10.0]"; 1001].join(", ");
    let long_name = "x".repeat(2000);
    let cases: Vec<(&str, &str, &str, &[&str])> = vec![
        ("20.0, 20.0]", "1e20, 20.0]", "2:11: region[0] = 1e20: ", &["from 0.5 to 3000 metres"]),
        ("20.0, 20.0]", "1e4, 1e4]", "2:11: region[0] = 1e4: ", &["3000"]),
        ("20.0, 20.0]", "900.0, 900.0]", "2:10: region = [900.0, 900.0]: ", &["lattice nodes", "smaller"]),
        ("20.0, 20.0]", "200.0, 200.0]", "2:10: region = [200.0, 200.0]: ", &["--scale 0.25", "scale up to"]),
        ("20.0, 20.0]", "-0.0, 20.0]", "2:11: region[0] = -0.0: ", &["0.5"]),
        ("20.0, 20.0]", "5e-324, 20.0]", "2:11: region[0] = 5e-324: ", &["0.5"]),
        ("20.0, 20.0]", "nan, 20.0]", "2:11: region[0] = nan: ", &["0.5"]),
        ("20.0, 20.0]", "20.0, 20.0, 20.0]", "2:10: region = [20.0, 20.0, 20.0]: ", &["length 3", "two numbers"]),
        ("20.0, 20.0]", "\"wide\", 20.0]", "2:11: region[0] = \"wide\": ", &["must be a number, and is a text"]),
        ("snapshots = 15", "snapshots = 10000", "3:13: snapshots = 10000: ", &["at most 791", "smaller region"]),
        ("snapshots = 15", "snapshots = 0", "3:13: snapshots = 0: ", &["1 to 10000"]),
        ("snapshots = 15", "snapshots = -3", "3:13: snapshots = -3: ", &["1 to 10000"]),
        ("snapshots = 15", "snapshots = 1e3", "3:13: snapshots = 1e3: ", &["whole number"]),
        ("snapshots = 15", "snapshots = 9223372036854775808", "3:13: snapshots = 9223372036854775808: ", &["whole"]),
        (
            "snapshots = 15",
            "snapshots = true",
            "3:13: snapshots = true: ",
            &["must be a whole number, and is true or false"],
        ),
        (
            "target_width = 1.5",
            "target_width = 150.0",
            "6:16: morphogen.target_width = 150.0: ",
            &["0.01 to 100 metres", "centi"],
        ),
        ("obstacle_width = 0.9", "obstacle_width = 0.0", "7:18: morphogen.obstacle_width = 0.0: ", &["0.01"]),
        ("level = 0.5", "level = 0.995", "8:9: morphogen.level = 0.995: ", &["0.01 to 0.99"]),
        ("level = 0.5", "level = 50", "8:9: morphogen.level = 50: ", &["share"]),
        ("d_min = 1.0", "d_min = -inf", "10:9: ring.d_min = -inf: ", &["0 to 100"]),
        ("d_max = 2.0", "d_max = 1.0", "11:9: ring.d_max = 1.0: ", &["above d_min"]),
        ("d_max = 2.0", "d_max = 50.0", "11:9: ring.d_max = 50.0: ", &["does not fit the region"]),
        ("d_obstacle = 2.0", "d_obstacle = 1e9", "12:14: ring.d_obstacle = 1e9: ", &["0 to 100 metres"]),
        ("steepness = 10.0", "steepness = 0.001", "13:13: ring.steepness = 0.001: ", &["0.5 to 1000 per metre"]),
        ("steepness = 10.0", "steepness = 1e308", "13:13: ring.steepness = 1e308: ", &["1000"]),
        ("[17.0, 10.0]", "[27.0, 10.0]", "15:22: target[0].path[1] = [27.0, 10.0]: ", &["region, 20.0 x 20.0", "move"]),
        ("[17.0, 10.0]", "[10.0, 15.0]", "15:22: target[0].path[1] = [10.0, 15.0]: ", &["inside wall[0]", "move"]),
        ("[17.0, 10.0]", "[10.0, 19.0], [17.0, 10.0]", "15:22: target[0].path[1] = [10.0, 19.0]: ", &["wall[0]"]),
        (
            "[17.0, 10.0]",
            "[17.0, 10.0], [17.0, 2.0], [3.0, 2.0]",
            "15:49: target[0].path[3] = [3.0, 2.0]: ",
            &["meets wall[1]", "around"],
        ),
        ("[17.0, 10.0]", "[17.0]", "15:22: target[0].path[1] = [17.0]: ", &["length 1"]),
        ("[3.0, 10.0]", &many_points, "15:8: target[0].path = 1002 points: ", &["at most 1000"]),
        ("[[target]]\npath = [[3.0, 10.0], [17.0, 10.0]]\n", "", "target = 0 of them: ", &["1 to 10 [[target]]"]),
        (
            "[[wall]]",
            "[[target]]\npath = [[3.0, 10.0], [17.0, 10.0]]\n[[wall]]",
            "17:8: target[1].path: ",
            &["the same path as target[0]"],
        ),
        (", [14.0, 20.0], [6.0, 20.0]", "", "17:11: wall[0].polygon = 2 points: ", &["at least 3"]),
        ("[14.0, 20.0], [6.0, 20.0]", "[6.0, 20.0], [14.0, 20.0]", "17:52: wall[0].polygon[3]", &["meets", "cross"]),
        ("[14.0, 20.0], [6.0, 20.0]", "[9.0, 14.0]", "17:11: wall[0].polygon: ", &["no area"]),
        ("[14.0, 20.0]", "[14.0, nan]", "17:39: wall[0].polygon[2] = [14.0, nan]: ", &["finite"]),
        ("[14.0, 20.0]", "[1e300, 20.0]", "17:39: wall[0].polygon[2] = [1e300, 20.0]: ", &["outside the region"]),
        ("[14.0, 20.0]", "[14.0, 14.0]", "17:25: wall[0].polygon[1] = [14.0, 14.0]: ", &["differ from the next"]),
        ("name = \"world\"", "name = \"..\"", "1:8: name = \"..\": ", &["letters or digits"]),
        ("name = \"world\"", "name = \"\"", "1:8: name = \"\": ", &["letters or digits"]),
        ("name = \"world\"", "name = \"a\\u0007b\"", "1:8: name = \"a\\u0007b\": ", &["control"]),
        ("world", &long_name, "1:8: name = \"xxxx", &["2000 bytes", "at most 1000"]),
        ("20.0, 20.0]", "20.0, 20.0", "2:10: ", &["not closed", "add ]"]),
        ("[3.0, 10.0], [17.0, 10.0]]", "[3.0, 10.0], [17.0, 10.0]", "15:8: ", &["not closed", "add ]"]),
        ("[morphogen]", "[morphogen", "4:11: [morphogen: ", &["unclosed"]),
        ("name = \"world\"", "name = world", "1:8: name = world: ", &["quoted"]),
        ("d_min = 1.0", "d_min = 1,0", "10:10: d_min = 1,0: ", &["unexpected"]),
        ("d_min = 1.0", "d_min =", "10:8: d_min =: ", &["a value is missing"]),
        ("d_min = 1.0", "d_mni = 1.0", "10:1: ring.d_mni: ", &["unknown key", "did you mean d_min?"]),
        ("snapshots = 15", "colour = 15", "3:1: colour: ", &["unknown key", "known here: name, region"]),
        ("steepness = 10.0\n", "", "9:1: ring.steepness: ", &["is missing"]),
        ("d_min = 1.0", "d_min = 1.0\nd_min = 2.0", "11:1: d_min = 2.0: ", &["duplicate"]),
        ("gaussian", "box", "5:10: morphogen.kernel = \"box\": ", &["gaussian", "exponential"]),
    ];
    assert_all(cases.into_iter().map(|(from, to, place, words)| {
        let desk = Desk::new()?;
        std::fs::write(desk.path("world.toml"), edited(WORLD, from, to))?;
        let begins = format!("world.toml:{place}");
        let begins = if place.starts_with("target =") { format!("world.toml: {place}") } else { begins };
        let words: Vec<&str> = [begins.as_str()].into_iter().chain(words.iter().copied()).collect();
        desk.refuses(&["evolve", "world.toml"], &words, to.get(..60).unwrap_or(to))
    }));
    Ok(())
}

#[test]
fn wrong_campaigns() -> Outcome {
    let vast = format!("level = [{}]", (0..17).map(|i| format!("1.{i:02}")).collect::<Vec<_>>().join(", "));
    let many = "[[method]]\nname = \"x\"\nalgorithm = \"eh-grn\"\nstructure = 1\n";
    let many: String = (0..5).map(|i| many.replace('x', &format!("x{i}"))).collect::<String>() + "[[model]]";
    let cases: Vec<(&str, &str, &str, &[&str])> = vec![
        ("seeds = 1", "seeds = 0", "2:9: seeds = 0: ", &["1 to 10000"]),
        ("seeds = 1", "seeds = -1", "2:9: seeds = -1: ", &["1 to 10000"]),
        ("seeds = 1", "sedes = 1", "2:1: sedes: ", &["did you mean seeds?"]),
        (
            "evaluations = 800",
            "evaluations = 10000000000",
            "5:15: scenario[0].evaluations = 10000000000: ",
            &["10000000"],
        ),
        ("evaluations = 800", "evaluations = 9", "5:15: scenario[0].evaluations = 9: ", &["800"]),
        (
            "evaluations = 800",
            "evaluations = 9000000",
            "2:9: seeds = 1000: ",
            &["evaluations of all runs", "fewer seeds"],
        ),
        ("file = \"world.toml\"", "file = \"no.toml\"", "4:8: scenario[0].file = \"no.toml\": ", &["cannot be read"]),
        (
            "file = \"world.toml\"",
            "file = \"blob.grn\"",
            "4:8: scenario[0].file = \"blob.grn\": ",
            &["a blob", "not a scenario"],
        ),
        ("file = \"world.toml\"", "file = \".\"", "4:8: scenario[0].file = \".\": ", &["folder"]),
        (
            "file = \"blob.grn\"",
            "file = \"world.toml\"",
            "16:8: model[0].file = \"world.toml\": ",
            &["a scenario", "not a blob"],
        ),
        ("motifs = \"all\"", "motifs = \"some\"", "9:10: method[0].motifs = \"some\": ", &["all"]),
        ("motifs = \"all\"", "motif = \"all\"", "9:1: method[0].motif: ", &["did you mean motifs?"]),
        ("motifs = \"all\"\n", "", "method[0].motifs: ", &["is missing", "mogp"]),
        ("motifs = \"all\"", "motifs = \"all\"\nstructure = 1", "10:13: method[0].structure: ", &["no such key"]),
        (
            "motifs = \"all\"",
            "motifs = \"all\"\nde_generations = 99999999999",
            "10:18: method[0].de_generations = 99999999999: ",
            &["0 to 1000"],
        ),
        ("structure = 2", "structure = 3", "13:13: method[1].structure = 3: ", &["structure 3"]),
        ("structure = 2", "structure = -1", "13:13: method[1].structure = -1: ", &[]),
        (
            "algorithm = \"mogp\"",
            "algorithm = \"magic\"",
            "8:13: method[0].algorithm = \"magic\": ",
            &["mogp", "eh-grn"],
        ),
        ("name = \"e\"", "name = \"M!\"", "11:8: method[1].name = \"M!\": ", &["another method, \"m\"", "differ"]),
        ("name = \"e\"", "name = \"../..\"", "11:8: method[1].name = \"../..\": ", &["letters or digits"]),
        (
            "name = \"thrown\"",
            "name = \"World\"",
            "18:8: transfer[0].name = \"World\": ",
            &["another world, \"world\""],
        ),
        ("[\"world\"]", "[\"wrold\"]", "19:9: transfer[0].from[0] = \"wrold\": ", &["there are world"]),
        ("worlds = 3", "worlds = 1000000000000", "21:21: transfer[0].random.worlds = 1000000000000: ", &["1 to 1000"]),
        ("density = 0.03", "density = 2.0", "transfer[0].random.density = 2.0: ", &["0.001 to 0.5"]),
        ("radius = [0.3, 0.6]", "radius = [1e-6, 1e-6]", "transfer[0].random.radius[0] = 1e-6: ", &["0.01 to 100"]),
        (
            "radius = [0.3, 0.6]",
            "radius = [0.01, 0.01]",
            "transfer[0].random.radius[0] = 0.01: ",
            &["obstacles of this size"],
        ),
        ("radius = [0.3, 0.6]", "radius = [0.6, 0.3]", "transfer[0].random.radius[1] = 0.3: ", &["at least the least"]),
        ("clearance = 1.5", "clearance = 12.0", "transfer[0].random.density = 0.03: ", &["no room"]),
        ("clearance = 1.5", "clearance = 1.5, depth = 1", "transfer[0].random.depth: ", &["unknown key"]),
        (
            "level = [0.9, 1.1]",
            "level = [0.9, 4.0]",
            "23:15: vary.level[1] = 4.0: ",
            &["morphogen.level", "0.01 to 0.99"],
        ),
        ("level = [0.9, 1.1]", "level = [0.9, 0.9]", "23:15: vary.level[1] = 0.9: ", &["twice"]),
        ("level = [0.9, 1.1]", "level = [nan]", "23:10: vary.level[0] = nan: ", &["0.01 to 100"]),
        ("level = [0.9, 1.1]", "world = [0.01]", "23:10: vary.world[0] = 0.01: ", &["region[0]", "0.5"]),
        ("level = [0.9, 1.1]", "world = [99.0]", "23:10: vary.world[0] = 99.0: ", &["region"]),
        ("level = [0.9, 1.1]", &vast, "23:9: vary.level = 17 factors: ", &["at most 16"]),
        ("[[model]]", &many, "method = 7 of them: ", &["at most 6"]),
    ];
    assert_all(cases.into_iter().map(|(from, to, place, words)| {
        let desk = Desk::new()?;
        let mut text = edited(CAMPAIGN, from, to);
        if place.contains("seeds = 1000:") {
            text = edited(&text, "seeds = 1", "seeds = 1000");
        }
        std::fs::write(desk.path("campaign.toml"), text)?;
        let words: Vec<&str> = ["campaign.toml:", place].into_iter().chain(words.iter().copied()).collect();
        desk.refuses(&["campaign", "campaign.toml"], &words, to)
    }));
    // What is wrong in a world is told with its own place.
    let desk = Desk::new()?;
    std::fs::write(desk.path("world.toml"), edited(WORLD, "level = 0.5", "level = 0.0"))?;
    desk.refuses(&["campaign", "campaign.toml"], &["world.toml:8:9: morphogen.level = 0.0: "], "a wrong world")
}

#[test]
fn wrong_files() -> Outcome {
    let desk = Desk::new()?;
    std::fs::write(desk.path("empty"), "")?;
    std::fs::write(desk.path("binary"), b"\x7fELF\x00\xff")?;
    std::fs::write(desk.path("utf16"), b"\xff\xfen\0")?;
    std::fs::write(desk.path("deep"), format!("x = {}", "[".repeat(100_000)))?;
    std::fs::write(desk.path("long"), vec![b'#'; 5 << 20])?;
    std::fs::create_dir(desk.path("folder"))?;
    let cases: [(&[&str], &[&str]); 19] = [
        (&["evolve", "blob.grn"], &["blob.grn: this is a blob", "not a scenario", "give"]),
        (&["evolve", "campaign.toml"], &["campaign.toml: this is a campaign", "grn campaign"]),
        (&["evolve", "folder"], &["folder: this is a folder", "give a file"]),
        (&["evolve", "empty"], &["empty: this is an empty file", "not a scenario"]),
        (&["evolve", "binary"], &["binary: this is a binary file", "not a scenario"]),
        (&["evolve", "utf16"], &["utf16: this is a text in UTF-16", "UTF-8"]),
        (&["evolve", "deep"], &["deep:1:", "recur"]),
        (&["evolve", "long"], &["long: longer than 4 MiB"]),
        (&["evolve", "none"], &["none: cannot be read"]),
        (&["campaign", "world.toml"], &["world.toml: this is a scenario", "not a campaign"]),
        (&["campaign", "blob.grn"], &["blob.grn: this is a blob", "not a campaign"]),
        (&["show", "world.toml"], &["world.toml: this is a scenario", "not a blob", ".grn"]),
        (&["show", "folder"], &["folder: this is a folder"]),
        (&["show", "empty"], &["empty: this is an empty file"]),
        (&["show", "long"], &["long: longer than 4 MiB"]),
        (&["draw", "world.toml", "blob.grn"], &["world.toml: this is a scenario", "not a blob"]),
        (&["draw", "blob.grn", "blob.grn"], &["blob.grn: this is a blob", "not a scenario"]),
        (&["simulate", "campaign.toml", "world.toml"], &["campaign.toml: this is a campaign", "not a blob"]),
        (&["eval", "binary"], &["binary: this is a binary file", "not a blob"]),
    ];
    assert_all(cases.iter().map(|(arguments, words)| desk.refuses(arguments, words, arguments[1])));
    if cfg!(unix) {
        desk.refuses(&["evolve", "/dev/zero"], &["/dev/zero: longer than 4 MiB"], "a device without end")?;
        desk.refuses(&["flash", "/dev/zero", "--out", "x"], &["/dev/zero: longer than 4 MiB"], "a device without end")?;
        desk.refuses(&["show", "/dev/null"], &["/dev/null: this is an empty file"], "a device with nothing")?;
    }
    Ok(())
}

#[test]
fn wrong_options() -> Outcome {
    let desk = Desk::new()?;
    let cases: [(&[&str], &[&str]); 23] = [
        (&["evolve", "world.toml", "--threads", "100000"], &["--threads", "100000", "cores"]),
        (&["evolve", "world.toml", "--threads", "0"], &["--threads", "from 1"]),
        (&["campaign", "campaign.toml", "--threads", "100000"], &["--threads", "100000", "cores"]),
        (&["evolve", "world.toml", "--evaluations", "7"], &["evaluations", "7", "800"]),
        (&["evolve", "world.toml", "--evaluations", "18446744073709551615"], &["--evaluations", "10000000"]),
        (&["evolve", "world.toml", "--evaluations", "1e5"], &["--evaluations", "1e5"]),
        (&["evolve", "world.toml", "--scale", "0"], &["--scale", "0.01 to 10"]),
        (&["evolve", "world.toml", "--scale", "nan"], &["--scale", "nan", "0.01 to 10"]),
        (&["evolve", "world.toml", "--scale", "10"], &["world.toml:2:10: region", "--scale 10", "scale up to 1.5"]),
        (&["evolve", "world.toml", "--scale", "0.01"], &["world.toml:2:10: region", "--robots 12", "no room"]),
        (&["evolve", "world.toml", "--seed", "1.5"], &["--seed", "1.5"]),
        (&["evolve", "world.toml", "--objectives", "nodes,loop"], &["--objectives", "loop", "closed-loop, worst"]),
        (&["evolve", "world.toml", "--constraints", "islands"], &["--constraints", "islands", "no-islands"]),
        (&["evolve", "world.toml", "--realities", "0"], &["--realities", "1 to 1000"]),
        (&["evolve", "world.toml", "--paper", "--realities", "3"], &["--paper", "--realities"]),
        (&["simulate", "blob.grn", "world.toml", "--robots", "20000"], &["--robots", "20000", "1 to 10000"]),
        (&["simulate", "blob.grn", "world.toml", "--robots", "0"], &["--robots", "0", "1 to 10000"]),
        (&["simulate", "blob.grn", "world.toml", "--scale", "1e9"], &["--scale", "1e9", "0.01 to 10"]),
        (&["simulate", "blob.grn", "world.toml", "--emulated", "999"], &["--emulated", "999"]),
        (&["scatter", "world.toml", "--density", "1e300"], &["--density", "0.001 to 0.5"]),
        (&["scatter", "world.toml", "--radius", "0.01", "0.01"], &["world.toml: --radius = 0.01", "obstacles"]),
        (&["scatter", "world.toml", "--radius", "1e-6", "1e-6"], &["--radius", "1e-6", "0.01"]),
        (&["scatter", "world.toml", "--clearance", "inf"], &["--clearance", "inf"]),
    ];
    assert_all(cases.iter().map(|(arguments, words)| desk.refuses(arguments, words, &arguments.join(" "))));
    Ok(())
}

/// A minus sign is the beginning of a number here, not of an option.
#[test]
fn negative_numbers() -> Outcome {
    let desk = Desk::new()?;
    let evolve: &[&str] = &["evolve", "world.toml"];
    let campaign: &[&str] = &["campaign", "campaign.toml"];
    let simulate: &[&str] = &["simulate", "blob.grn", "world.toml"];
    let scatter: &[&str] = &["scatter", "world.toml"];
    let (upload, slot): (&[&str], &[&str]) =
        (&["flash", "blob.grn", "--to", "tcp:x:1"], &["flash", "blob.grn", "--out", "x"]);
    let cases: [(&[&str], &str, &str); 20] = [
        (evolve, "--seed", "from 0 to 18446744073709551615"),
        (evolve, "--threads", "from 1 to"),
        (evolve, "--evaluations", "from 1 to 10000000"),
        (evolve, "--scale", "from 0.01 to 10"),
        (campaign, "--threads", "from 1 to"),
        (campaign, "--shard", "2/3"),
        (simulate, "--seed", "from 0 to"),
        (simulate, "--robots", "from 1 to 10000"),
        (simulate, "--scale", "from 0.01 to 10"),
        (simulate, "--speed", "above 0 and at most 0.127"),
        (simulate, "--emulated", "from 1 to 10000"),
        (scatter, "--seed", "from 0 to"),
        (scatter, "--density", "from 0.001 to 0.5"),
        (scatter, "--clearance", "from 0"),
        (upload, "--baud", "from 1 to"),
        (slot, "--address", "0x"),
        (slot, "--sequence", "0 to 4000000000"),
        (&["robots", "tcp:x:1"], "--baud", "from 1 to"),
        (&["confirm", "tcp:x:1"], "--baud", "from 1 to"),
        (&["rollback", "tcp:x:1"], "--baud", "from 1 to"),
    ];
    assert_all(cases.iter().flat_map(|&(command, option, words)| {
        let desk = &desk;
        ["-1", "-1e-6", "-inf"].map(|number| {
            let option_and_number = [option, number];
            desk.refuses(&[command, &option_and_number].concat(), &[option, number, words], option)
        })
    }));
    desk.refuses(
        &["scatter", "world.toml", "--radius", "-1", "-2"],
        &["--radius", "-1", "from 0.01 to 100"],
        "--radius",
    )
}

/// Each was taken and did nothing, or something else than it says.
#[test]
fn options_of_emulators_without_emulators() -> Outcome {
    let desk = Desk::new()?;
    let simulate = ["simulate", "blob.grn", "world.toml", "--robots", "12"];
    let cases: [(&[&str], &[&str]); 5] = [
        (&["--image", "blob.grn"], &["--image blob.grn", "add --target qemu, or leave it out"]),
        (&["--emulated", "2"], &["--emulated 2", "add --target qemu, or leave it out"]),
        (&["--target", "native", "--emulated", "2"], &["--emulated 2", "add --target qemu, or leave it out"]),
        (&["--target", "qemu", "--emulated", "13"], &["--emulated 13", "the number of robots, 12"]),
        (&["--target", "qemu", "--image", "blob.grn"], &["blob.grn is no image", "cargo xtask target"]),
    ];
    let cases = if cfg!(unix) { &cases[..] } else { &cases[..3] };
    assert_all(cases.iter().map(|(more, words)| desk.refuses(&[&simulate, *more].concat(), words, &more.join(" "))));
    Ok(())
}

#[test]
fn tiny_and_huge_numbers_are_told_in_short() -> Outcome {
    let desk = Desk::new()?;
    for number in ["5e-324", "1e300", "-1e300"] {
        let told = format!("--speed {number}: ");
        desk.refuses(&["simulate", "blob.grn", "world.toml", "--speed", number], &[&told], number)?;
        std::fs::write(desk.path("world.toml"), edited(WORLD, "snapshots = 15", &format!("snapshots = {number}")))?;
        let told = format!("world.toml:3:13: snapshots = {number}: must be a whole number, without point and exponent");
        desk.refuses(&["evolve", "world.toml"], &[&told], number)?;
        std::fs::write(desk.path("world.toml"), WORLD)?;
    }
    Ok(())
}
