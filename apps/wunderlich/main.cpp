/// The program `wunderlich`: what the user says, sorted into commands, and what goes wrong, sorted into exit codes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "commands.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/base/version.hpp"
#include "wunderlich/io/formats.hpp"

namespace wunderlich::app {

namespace {

/// An empty name is a slip of a script: `--out "$unset"`.
std::string not_empty(const std::string& name) { return name.empty() ? "must not be empty" : ""; }

void add_set(CLI::App& command, std::vector<std::string>& set) {
  command.add_option("--set", set, "Override any key of the scene: key.path=value, with a YAML value; repeatable")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
}

void add_run(CLI::App& program, RunArguments& arguments, int& exit_code) {
  CLI::App* command = program.add_subcommand("run", "Run a scene and write its run folder");
  command->add_option("scene", arguments.scene, "A scene file, or the name of a shipped scene")
      ->required()
      ->type_name("SCENE");
  command
      ->add_option("--out", arguments.out, "The run folder; default out/<scene>. A run folder there is replaced whole")
      ->check(not_empty)
      ->type_name("DIR");
  add_set(*command, arguments.set);
  command
      ->add_option("--formats", arguments.formats,
                   "vtp,glb,pc2,obj,stl,3mf,svg,html,png,mp4 or none; default: the scene's, vtp,glb,svg,html,png")
      ->type_name("LIST");
  command->add_flag("--resume", arguments.resume, "Go on with an interrupted run, exactly as if it had not been");
  command->add_flag("--quiet", arguments.quiet, "Say nothing but errors");
  command->callback([&] { exit_code = run_command(arguments); });
}

void add_check(CLI::App& program, RunArguments& arguments, int& exit_code) {
  CLI::App* command = program.add_subcommand("check", "Read a scene and say whether it is valid");
  command->add_option("scene", arguments.scene, "A scene file, or the name of a shipped scene")
      ->required()
      ->type_name("SCENE");
  add_set(*command, arguments.set);
  command->callback([&] { exit_code = check_command(arguments.scene, arguments.set); });
}

void add_export(CLI::App& program, ExportArguments& arguments, int& exit_code) {
  CLI::App* command = program.add_subcommand("export", "Write a finished or interrupted run in another format");
  command->add_option("run", arguments.run, "A run folder")->required()->type_name("RUN");
  command
      ->add_option(
          "--to", arguments.format,
          io::format_names() + "; svg-pattern is svg, stl and 3mf are bodies to print, png a still, mp4 a film")
      ->required()
      ->type_name("FORMAT");
  command
      ->add_option("--thickness", arguments.thickness,
                   "Of the body, for stl, 3mf and obj; default: ribbon.thickness, or a fiftieth of the width, for obj "
                   "the bare surface")
      ->type_name("METRES");
  command->add_option("--size", arguments.size, "Of a picture in pixels, for png and mp4; default 1200x750")
      ->type_name("WxH");
  command
      ->add_option("--view", arguments.view,
                   "Where the eye is, in degrees, for png and mp4: 0,0 looks along +y with z up; default: from where "
                   "most of the shape is seen")
      ->type_name("AZIMUTH,ELEVATION");
  command
      ->add_option("--colour", arguments.colour,
                   "Of the surface, for png and mp4: plain, kappa, tau, eta or energy; default plain")
      ->type_name("FIELD");
  command->add_option("--zoom", arguments.zoom, "On the middle of the shape, for png and mp4; default 1, all of it")
      ->type_name("FACTOR");
  command->add_option("--frame", arguments.frame, "The recorded frame that a png shows, from 0; default: the last")
      ->type_name("N");
  command->add_option("--fps", arguments.fps, "Recorded frames a second of an mp4; default 25")->type_name("RATE");
  command->add_option("--out", arguments.out, "The file to write; default: in the run folder")
      ->check(not_empty)
      ->type_name("FILE");
  command->callback([&] { exit_code = export_command(arguments); });
}

void add_sweep_run(CLI::App& command, SweepArguments& arguments) {
  command.add_option("sweep", arguments.sweep, "A sweep file")->type_name("SWEEP");
  command.add_option("--out", arguments.out, "The sweep's folder; default out/<sweep>. What is there already is kept")
      ->check(not_empty)
      ->type_name("DIR");
  command.add_option("--engine", arguments.engine, "local: processes on this machine; slurm: a job array of shards")
      ->type_name("ENGINE");
  command.add_option("--shard", arguments.shard, "Only the I-th of N parts, for any other engine")->type_name("I/N");
  command.add_option("--jobs", arguments.jobs, "Processes; default one a core, on Slurm one a shard")->type_name("N");
  command.add_flag("--retry", arguments.retry, "Do again what failed, timed out or did not converge");
  command.add_option("--shards", arguments.shards, "Slurm: parts of the array; default one for every 500 runs")
      ->type_name("N");
  command.add_option("--walltime", arguments.walltime, "Slurm: limit of a shard, as sbatch takes it")
      ->type_name("TIME");
  command.add_option("--partition", arguments.partition, "Slurm: where to run")->type_name("NAME");
  command.add_flag("--no-requeue", arguments.no_requeue, "Slurm: do not start a shard again whose node failed");
  command.add_option("--sbatch", arguments.sbatch, "Slurm: a further argument of sbatch; repeatable")
      ->allow_extra_args(false)
      ->type_name("ARGUMENT");
  command.add_flag("--quiet", arguments.quiet, "Say nothing but errors");
}

void add_sweep(CLI::App& program, SweepArguments& arguments, std::string& folder, int& exit_code) {
  CLI::App* command = program.add_subcommand("sweep", "Run a scene for many values of its keys");
  add_sweep_run(*command, arguments);
  CLI::App* status = command->add_subcommand("status", "Say how a sweep stands");
  CLI::App* collect = command->add_subcommand("collect", "Write the table and the page of what a sweep has so far");
  for (CLI::App* inner : {status, collect}) {
    inner->add_option("folder", folder, "The sweep's folder")->required()->type_name("DIR");
  }
  command->require_subcommand(0, 1);
  command->callback([&, command, status] {
    const bool inner = !command->get_subcommands().empty();
    if (!inner && arguments.sweep.empty()) throw CLI::RequiredError("sweep");
    exit_code = !inner             ? sweep_command(arguments)
                : status->parsed() ? sweep_status_command(folder)
                                   : sweep_collect_command(folder);
  });
}

void add_compare(CLI::App& program, CompareArguments& arguments, int& exit_code) {
  CLI::App* command = program.add_subcommand("compare", "Run a scene by other models as well, side by side");
  command->add_option("scene", arguments.scene, "A scene file, or the name of a shipped scene")
      ->required()
      ->type_name("SCENE");
  command
      ->add_option("--models", arguments.models, "Some of ribbon,rod,shell-conforming,shell-nonconforming; default all")
      ->type_name("LIST");
  command->add_option("--out", arguments.out, "The folder; default out/<scene>-compare. A comparison there is replaced")
      ->check(not_empty)
      ->type_name("DIR");
  add_set(*command, arguments.set);
  command->add_flag("--quiet", arguments.quiet, "Say nothing but errors");
  command->callback([&] { exit_code = compare_command(arguments); });
}

int report(int code, const std::string& message) {
  std::cerr << message << "\n";
  return code;
}

int run_program(int argc, char** argv) {
  CLI::App program{"Wunderlich: geometrically exact simulation of inextensible ribbons", "wunderlich"};
  program.set_version_flag("--version", std::string(wunderlich::program) + " " + version);
  program.require_subcommand(1);
  int exit_code = done;
  RunArguments run;
  RunArguments check;
  ExportArguments exported;
  SweepArguments swept;
  std::string sweep_folder;
  CompareArguments compared;
  add_run(program, run, exit_code);
  add_check(program, check, exit_code);
  program.add_subcommand("scenes", "List the shipped scenes")->callback([&] { exit_code = scenes_command(); });
  add_export(program, exported, exit_code);
  add_sweep(program, swept, sweep_folder, exit_code);
  add_compare(program, compared, exit_code);
  CLI::App* schema = program.add_subcommand("schema", "Print the scene format as Markdown");
  bool json = false;
  schema->add_flag("--json", json, "As a JSON Schema, for editors");
  schema->callback([&] { exit_code = schema_command(json); });
  const auto asked_for = [&](const CLI::App* command) { return command->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && program.get_subcommands(asked_for).empty()) {
    return report(bad_input, fmt::format("there is no command '{}'; wunderlich --help lists what there is", argv[1]));
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? done : bad_input;
  }
  return exit_code;
}

}  // namespace

}  // namespace wunderlich::app

int main(int argc, char** argv) {
  using namespace wunderlich;
  try {
    return app::run_program(argc, argv);
  } catch (const InputError& error) {
    return app::report(app::bad_input, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return app::report(app::bad_input, error.what());
  } catch (const std::domain_error& error) {
    return app::report(app::not_converged, std::string("nothing was written: ") + error.what());
  } catch (const std::bad_alloc&) {
    return app::report(app::bad_input, "not enough memory for this scene; lower ribbon.segments or output.frames");
  }
}
