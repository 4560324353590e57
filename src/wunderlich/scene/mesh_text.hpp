/// Meshes of obstacles: OBJ files and their text.
#pragma once

#include "wunderlich/contact/triangle_mesh.hpp"
#include "wunderlich/scene/document.hpp"

namespace wunderlich::scene {

/// A closed surface from the text of an OBJ file: vertices `v` times `scale`, faces `f` of three corners or more (cut
/// into triangles from their first one), counter-clockwise seen from outside. Normals, textures, groups and materials
/// are passed over. Throws InputError `source:line: problem`.
contact::TriangleMesh mesh_from_obj(const std::string& text, const std::string& source, double scale);

/// Puts the text of the files that obstacles name (`file`, from the folder on) into the document (`obj`), so that it is
/// all that a run needs. Throws InputError where a file is no mesh.
void embed_meshes(const std::string& folder, Value& document);

}  // namespace wunderlich::scene
