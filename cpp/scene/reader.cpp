// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/reader.h"
#include "scene/check.h"
#include "scene/take.h"
#include <fstream>
#include <sstream>

namespace mmale::scene
{
FileText load(const std::filesystem::path& path, const std::string& kind)
{
  const auto complaint = [&](const std::string& what)
  { return FileText{"", {{"", what, {path.string(), 0}}}}; };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (not std::filesystem::exists(status))
    return complaint("no such file");
  if (std::filesystem::is_directory(status))
  {
    const std::filesystem::path usual = path / (kind + ".toml");
    return complaint(std::filesystem::exists(usual, error)
                         ? "is a folder; the " + kind + " is " + usual.string()
                         : "is a folder, not a " + kind);
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (not file or not(text << file.rdbuf()))
    return complaint(std::filesystem::file_size(path, error) == 0
                         ? "is empty"
                         : "cannot be read");
  return {text.str(), {}};
}

Reading read(std::string_view text, const std::string& file,
             std::span<const Override> overrides, const Libraries& libraries,
             const OutlineReader& read_mesh, const DomainReader& read_domain,
             const RegionReader& read_region)
{
  Reading reading;
  reading.complaints = take(
      parse(text, file), overrides, reading.scene,
      [&](Scene& scene)
      {
        const std::string folder = std::filesystem::path(file).parent_path();
        scene.mesh.folder = folder;
        for (auto& [name, domain] : scene.domain)
          domain.folder = folder;
        for (Region& region : scene.region)
          region.drawing.folder = folder;
        for (auto& [name, material] : scene.material)
          material.folder = folder;
        return check(scene, libraries, read_mesh, read_domain, read_region);
      });
  return reading;
}
} // namespace mmale::scene
