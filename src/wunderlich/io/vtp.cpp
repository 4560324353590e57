#include "wunderlich/io/vtp.hpp"

#include <fmt/format.h>

#include <cassert>

#include "wunderlich/io/bytes.hpp"

namespace wunderlich::io {

namespace {

/// Collects the appended blocks, each led by its length in bytes.
struct Blocks {
  std::string bytes;

  /// The element that points at `block`, which is appended.
  std::string add(const char* type, const std::string& name, int components, const std::string& block) {
    const std::size_t offset = bytes.size();
    append(bytes, static_cast<std::uint32_t>(block.size()));
    bytes += block;
    return fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)",
                       type, name, components, offset);
  }
};

std::string packed(const std::vector<Vec3>& vectors) {
  std::string out;
  for (const Vec3& v : vectors) append_float3(out, v);
  return out;
}

std::string packed(const std::vector<double>& values) {
  std::string out;
  for (const double value : values) append(out, static_cast<float>(value));
  return out;
}

std::string point_data(const Mesh& mesh, Blocks& blocks) {
  std::string out = fmt::format("<PointData{} Normals=\"normals\">\n", mesh.fields.empty() ? "" : " Scalars=\"kappa\"");
  for (const PointField& field : mesh.fields) {
    assert(field.values.size() == mesh.points.size());
    out += blocks.add("Float32", field.name, 1, packed(field.values)) + "\n";
  }
  return out + blocks.add("Float32", "normals", 3, packed(mesh.normals)) + "\n</PointData>\n";
}

std::string polygons(const Mesh& mesh, Blocks& blocks) {
  std::string connectivity, offsets;
  std::int32_t end = 0;
  for (const auto& triangle : mesh.triangles) {
    for (const int point : triangle) append(connectivity, static_cast<std::int32_t>(point));
    append(offsets, end += 3);
  }
  return fmt::format("<Polys>\n{}\n{}\n</Polys>\n", blocks.add("Int32", "connectivity", 1, connectivity),
                     blocks.add("Int32", "offsets", 1, offsets));
}

}  // namespace

std::string vtp(const Mesh& mesh, double time) {
  Blocks blocks;
  std::string out =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n<PolyData>\n";
  out += fmt::format(
      "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{}</DataArray>\n"
      "</FieldData>\n",
      time);
  out += fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n",
      mesh.points.size(), mesh.triangles.size());
  out += point_data(mesh, blocks);
  out += "<Points>\n" + blocks.add("Float32", "points", 3, packed(mesh.points)) + "\n</Points>\n";
  out += polygons(mesh, blocks);
  out += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  return out + blocks.bytes + "\n</AppendedData>\n</VTKFile>\n";
}

std::string vtp(const std::vector<Body>& bodies, std::size_t frame, double time) {
  Mesh all;
  for (const Body& body : bodies) {
    const Pose& pose = body.poses[frame];
    const int first = static_cast<int>(all.points.size());
    for (const Vec3& point : body.mesh.points) all.points.push_back(pose.position + pose.frame * point);
    for (const Vec3& normal : body.mesh.normals) all.normals.push_back(pose.frame * normal);
    for (const auto& [a, b, c] : body.mesh.triangles) all.triangles.push_back({first + a, first + b, first + c});
  }
  return vtp(all, time);
}

std::string pvd(const std::vector<double>& times, const std::vector<std::string>& files) {
  assert(times.size() == files.size());
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  for (std::size_t i = 0; i < times.size(); ++i) {
    out += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", times[i], files[i]);
  }
  return out + "</Collection>\n</VTKFile>\n";
}

}  // namespace wunderlich::io
