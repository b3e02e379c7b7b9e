// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support.h"
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

using namespace mmale::scene;
namespace fs = std::filesystem;

namespace
{
std::vector<fs::path> bad_scenes()
{
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(BAD_SCENES))
    if (entry.path().extension() == ".toml")
      paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

std::string content(const fs::path& path)
{
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Folder of this test's own, removed at the end.
struct Folder
{
  fs::path path =
      fs::temp_directory_path() / ("mmale_scene_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};
} // namespace

TEST_CASE("bad scenes: each gets all of its complaints, word by word",
          "[scene]")
{
  const auto paths = bad_scenes();
  REQUIRE(paths.size() >= 30);
  for (const fs::path& path : paths)
  {
    INFO(path.filename());
    const Reading reading =
        read(content(path), path.filename().string(), {}, test::libraries());
    const std::string expected =
        content(fs::path(path).replace_extension(".txt"));
    CHECK(not expected.empty());
    CHECK(test::text_of(reading.complaints) == expected);
  }
}

TEST_CASE("files: missing, a folder and empty are complaints", "[scene]")
{
  const Folder folder;
  const auto words = [](const fs::path& path)
  { return test::text_of(load(path).complaints); };
  const std::string name = folder.path.string();

  CHECK(words(folder.path / "no.toml") == name + "/no.toml: no such file\n");
  CHECK(words(folder.path) == name + ": is a folder, not a scene\n");

  std::ofstream(folder.path / "scene.toml").close();
  CHECK(words(folder.path)
        == name + ": is a folder; the scene is " + name + "/scene.toml\n");
  CHECK(words(folder.path / "scene.toml") == name + "/scene.toml: is empty\n");

  std::ofstream(folder.path / "scene.toml") << "title = \"x\"\n";
  const FileText good = load(folder.path / "scene.toml");
  CHECK(good.complaints.empty());
  CHECK(good.text == "title = \"x\"\n");
}

TEST_CASE("files: any bytes are read without a crash", "[scene]")
{
  // Every prefix of a good scene is a scene somebody saved half-way.
  const std::string text = content(fs::path(DEMOS) / "piercing/scene.toml");
  for (std::size_t n = 0; n < text.size(); n += 7)
  {
    const Reading reading = test::read(text.substr(0, n));
    for (const Complaint& complaint : reading.complaints)
    {
      CHECK(not complaint.what.empty());
      CHECK(complaint.place.file == "scene.toml");
      CHECK(complaint.place.line >= 1);
    }
  }
}
