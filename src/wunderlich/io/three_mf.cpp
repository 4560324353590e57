#include "wunderlich/io/three_mf.hpp"

#include <fmt/format.h>

#include <iterator>

#include "wunderlich/base/version.hpp"
#include "wunderlich/io/millimetres.hpp"
#include "wunderlich/io/xml.hpp"
#include "wunderlich/io/zip.hpp"

namespace wunderlich::io {

namespace {

const char* const declaration = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

const char* const content_types = R"(<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";

const char* const relationships =
    R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";

void append_object(std::string& out, const Solid& solid, std::size_t id, const std::string& name) {
  auto end = std::back_inserter(out);
  fmt::format_to(end, "<object id=\"{}\" type=\"model\" name=\"{}\"><mesh><vertices>\n", id, escaped_xml(name));
  for (const Vec3& p : solid.points) {
    fmt::format_to(end, "<vertex x=\"{:.9g}\" y=\"{:.9g}\" z=\"{:.9g}\"/>\n", mm * p.x(), mm * p.y(), mm * p.z());
  }
  out += "</vertices><triangles>\n";
  for (const auto& t : solid.triangles) {
    fmt::format_to(end, "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", t[0], t[1], t[2]);
  }
  out += "</triangles></mesh></object>\n";
}

}  // namespace

std::string three_mf(const std::vector<Solid>& solids, const std::string& name) {
  std::string model = declaration;
  model +=
      "<model unit=\"millimeter\" xml:lang=\"en-US\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n";
  model += fmt::format("<metadata name=\"Title\">{}</metadata>\n<metadata name=\"Application\">{} {}</metadata>\n",
                       escaped_xml(name), program, version);
  model += "<resources>\n";
  std::string build = "<build>\n";
  for (std::size_t i = 0; i < solids.size(); ++i) {
    append_object(model, solids[i], i + 1, i == 0 ? name : fmt::format("{} {}", name, i + 1));
    build += fmt::format("<item objectid=\"{}\"/>\n", i + 1);
  }
  model += "</resources>\n" + build + "</build>\n</model>\n";
  return zip({{"[Content_Types].xml", std::string(declaration) + content_types},
              {"_rels/.rels", std::string(declaration) + relationships},
              {"3D/3dmodel.model", std::move(model)}});
}

}  // namespace wunderlich::io
