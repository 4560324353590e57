# Writes a source file with the texts of the shipped scenes. Run as a script: -DOUTPUT=... -DSCENES=a.yaml;b.yaml
set(entries "")
foreach(file IN LISTS SCENES)
  get_filename_component(name "${file}" NAME_WE)
  file(READ "${file}" text)
  string(APPEND entries "      {\"${name}\", R\"scene(${text})scene\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "// Generated from scenes/*.yaml.
#include \"wunderlich/scene/read.hpp\"

namespace wunderlich::scene {

const std::vector<ShippedScene>& shipped_scenes() {
  static const std::vector<ShippedScene> scenes{
${entries}  };
  return scenes;
}

}  // namespace wunderlich::scene
")
