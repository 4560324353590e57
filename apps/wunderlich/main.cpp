/// The program `wunderlich`: what the user says, sorted into commands, and what goes wrong, sorted into exit codes.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "commands.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/base/version.hpp"

namespace wunderlich::app {

namespace {

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
      ->type_name("DIR");
  add_set(*command, arguments.set);
  command
      ->add_option("--formats", arguments.formats,
                   "vtp,glb,pc2,obj,svg,html or none; default: the scene's, vtp,glb,svg,html")
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
  command->add_option("--to", arguments.format, "vtp, glb, pc2, obj, svg or html")->required()->type_name("FORMAT");
  command->add_option("--out", arguments.out, "The file to write; default: in the run folder")->type_name("FILE");
  command->callback([&] { exit_code = export_command(arguments); });
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
  CompareArguments compared;
  add_run(program, run, exit_code);
  add_check(program, check, exit_code);
  program.add_subcommand("scenes", "List the shipped scenes")->callback([&] { exit_code = scenes_command(); });
  add_export(program, exported, exit_code);
  add_compare(program, compared, exit_code);
  CLI::App* schema = program.add_subcommand("schema", "Print the scene format as Markdown");
  schema->callback([&] { exit_code = schema_command(); })->group("");
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
