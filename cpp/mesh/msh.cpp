// SPDX-License-Identifier: LGPL-3.0-or-later
#include "msh.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <format>
#include <string_view>

namespace mmale::mesh
{
namespace
{
/// What stops the reading; never leaves this file.
struct Broken
{
  std::string what;
  int line; ///< 0: the file as a whole
};

/// gmsh's numbers of element types
constexpr int edge_type = 1, triangle_type = 2, point_type = 15;

/// The file, line by line, and the numbers of a line.
class Lines
{
public:
  explicit Lines(std::istream& text) : _text(text) {}

  /// The next line; false at the end of the file.
  bool next()
  {
    if (not std::getline(_text, _line))
      return false;
    ++_number;
    while (not _line.empty() and (_line.back() == '\r' or _line.back() == ' '))
      _line.pop_back();
    _at = 0;
    return true;
  }

  /// The next line of a section, which must be there.
  void next_in(std::string_view section)
  {
    if (not next())
      throw Broken{std::format("is cut off in the midst of ${}", section), 0};
    if (_line.starts_with('$'))
      throw Broken{std::format("${} ends too early, by {}", section, _line),
                   _number};
  }

  /// The next number of the line.
  template <class T>
  T take(const char* what)
  {
    while (_at < _line.size() and (_line[_at] == ' ' or _line[_at] == '\t'))
      ++_at;
    T value{};
    const char* begin = _line.data() + _at;
    const auto [end, error] =
        std::from_chars(begin, _line.data() + _line.size(), value);
    const bool whole =
        end == _line.data() + _line.size() or * end == ' ' or * end == '\t';
    if (error != std::errc() or not whole)
      fail(std::format("{} is expected here", what));
    if constexpr (std::is_floating_point_v<T>)
      if (not std::isfinite(value))
        fail(std::format("{} must be finite", what));
    _at = static_cast<std::size_t>(end - _line.data());
    return value;
  }

  std::int64_t whole(const char* what) { return take<std::int64_t>(what); }

  std::int64_t count(const char* what)
  {
    const auto n = whole(what);
    if (n < 0)
      fail(std::format("{} must not be negative, is {}", what, n));
    return n;
  }

  [[noreturn]] void fail(const std::string& what) const
  {
    throw Broken{what, _number};
  }

  const std::string& line() const { return _line; }
  int number() const { return _number; }

private:
  std::istream& _text;
  std::string _line;
  std::size_t _at = 0;
  int _number = 0;
};

using Groups = std::map<std::int64_t, std::vector<std::int64_t>>;

class Reader
{
public:
  Reader(std::istream& text, Msh& out) : _lines(text), _out(out) {}

  void read()
  {
    bool nodes = false, elements = false;
    while (_lines.next())
    {
      const std::string section = _lines.line();
      if (section.empty())
        continue;
      if (not section.starts_with('$'))
        _lines.fail(_major == 0 ? "is no gmsh mesh: $MeshFormat is missing"
                                : "a section is expected here, $Name");
      const std::string name = section.substr(1);
      if (_major == 0 and name != "MeshFormat" and name != "Comments")
        _lines.fail("is no gmsh mesh: $MeshFormat is missing");
      if (name == "MeshFormat")
        read_format();
      else if (name == "PhysicalNames")
        read_names();
      else if (name == "Entities" and _major == 4)
        read_entities();
      else if (name == "PartitionedEntities")
        _lines.fail("is cut into partitions; save the mesh as one");
      else if (name == "Nodes")
        nodes = true, _major == 2 ? read_nodes_2() : read_nodes_4();
      else if (name == "Elements")
        elements = true, _major == 2 ? read_elements_2() : read_elements_4();
      else
      {
        skip(name);
        continue;
      }
      if (not _lines.next())
        throw Broken{"is cut off before $End" + name, 0};
      if (_lines.line() != "$End" + name)
        _lines.fail("$End" + name + " is expected here");
    }
    if (_major == 0)
      throw Broken{"is no gmsh mesh: $MeshFormat is missing", 0};
    for (const auto& [there, name] :
         {std::pair(nodes, "$Nodes"), std::pair(elements, "$Elements")})
      if (not there)
        throw Broken{std::string("has no ") + name + "; is it cut off?", 0};
  }

private:
  void read_format()
  {
    _lines.next_in("MeshFormat");
    const auto version = _lines.take<double>("the version of the format");
    const auto binary = _lines.whole("0 for ASCII");
    if (version == 2.2)
      _major = 2;
    else if (version == 4.1)
      _major = 4;
    else
      _lines.fail(std::format("is MSH {}; save it as 4.1 or 2.2 "
                              "(Mesh.MshFileVersion)",
                              version));
    if (binary != 0)
      _lines.fail("is binary; save it as ASCII (Mesh.Binary = 0)");
  }

  void read_names()
  {
    _lines.next_in("PhysicalNames");
    for (auto n = _lines.count("the number of names"); n > 0; --n)
    {
      _lines.next_in("PhysicalNames");
      const auto dimension = _lines.whole("a dimension");
      const auto tag = _lines.whole("a tag");
      const auto open = _lines.line().find('"'),
                 close = _lines.line().rfind('"');
      if (open == close)
        _lines.fail("a name in \"\" is expected here");
      const auto name = _lines.line().substr(open + 1, close - open - 1);
      if (dimension == 1)
        _out.curve_names[tag] = name;
      if (dimension == 2)
        _out.surface_names[tag] = name;
    }
  }

  void read_entities()
  {
    _lines.next_in("Entities");
    std::int64_t count[4];
    for (auto& n : count)
      n = _lines.count("the number of entities");
    for (int dimension = 0; dimension < 4; ++dimension)
      for (auto n = count[dimension]; n > 0; --n)
      {
        _lines.next_in("Entities");
        const auto tag = _lines.whole("a tag");
        for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i)
          _lines.take<double>("a coordinate");
        if (dimension == 1 or dimension == 2)
          _groups[dimension][tag] = read_groups();
      }
  }

  std::vector<std::int64_t> read_groups()
  {
    std::vector<std::int64_t> out;
    for (auto n = _lines.count("the number of physical groups"); n > 0; --n)
      if (const auto tag = std::abs(_lines.whole("a physical group"));
          tag != 0) // negative: the other way round
        out.push_back(tag);
    return out;
  }

  void read_place(Msh::Node& node)
  {
    for (double& x : node.x)
      x = _lines.take<double>("a coordinate");
    node.line = _lines.number();
  }

  void read_nodes_2()
  {
    _lines.next_in("Nodes");
    for (auto n = _lines.count("the number of nodes"); n > 0; --n)
    {
      _lines.next_in("Nodes");
      Msh::Node node{
          .tag = _lines.whole("a node's number"), .x = {}, .line = 0};
      read_place(node);
      _out.nodes.push_back(node);
    }
  }

  void read_nodes_4()
  {
    _lines.next_in("Nodes");
    auto blocks = _lines.count("the number of blocks");
    const auto total = _lines.count("the number of nodes");
    for (; blocks > 0; --blocks)
    {
      _lines.next_in("Nodes");
      _lines.whole("a dimension");
      _lines.whole("an entity");
      _lines.whole("0 or 1");
      const auto n = _lines.count("the number of nodes");
      const std::size_t first = _out.nodes.size();
      for (std::int64_t i = 0; i < n; ++i)
      {
        _lines.next_in("Nodes");
        _out.nodes.push_back({_lines.whole("a node's number"), {}, 0});
      }
      for (std::size_t i = first; i < _out.nodes.size(); ++i)
      {
        _lines.next_in("Nodes");
        read_place(_out.nodes[i]);
      }
    }
    if (static_cast<std::int64_t>(_out.nodes.size()) != total)
      _lines.fail(std::format("{} nodes, but {} were announced",
                              _out.nodes.size(), total));
  }

  /// Nodes of an element, or a note that it cannot be used.
  void read_element(Msh::Element element, std::int64_t type)
  {
    element.line = _lines.number();
    if (type == point_type)
      return;
    if (type != edge_type and type != triangle_type)
    {
      auto& other = _out.others[static_cast<int>(type)];
      if (other.count++ == 0)
        other.first = element.tag, other.line = element.line;
      return;
    }
    const int n = type == edge_type ? 2 : 3;
    for (int i = 0; i < n; ++i)
      element.nodes[i] = _lines.whole("a node's number");
    (n == 2 ? _out.edges : _out.triangles).push_back(std::move(element));
  }

  void read_elements_2()
  {
    _lines.next_in("Elements");
    for (auto n = _lines.count("the number of elements"); n > 0; --n)
    {
      _lines.next_in("Elements");
      Msh::Element element{};
      element.tag = _lines.whole("an element's number");
      const auto type = _lines.whole("an element's type");
      const auto tags = _lines.count("the number of tags");
      for (std::int64_t i = 0; i < tags; ++i)
      {
        const auto tag = std::abs(_lines.whole("a tag"));
        if (i == 0 and tag != 0)
          element.groups = {tag};
        if (i == 1)
          element.entity = tag;
      }
      read_element(std::move(element), type);
    }
  }

  void read_elements_4()
  {
    _lines.next_in("Elements");
    auto blocks = _lines.count("the number of blocks");
    const auto total = _lines.count("the number of elements");
    std::int64_t read = 0;
    for (; blocks > 0; --blocks)
    {
      _lines.next_in("Elements");
      const auto dimension = _lines.whole("a dimension");
      const auto entity = _lines.whole("an entity");
      const auto type = _lines.whole("an element's type");
      const auto n = _lines.count("the number of elements");
      read += n;
      for (std::int64_t i = 0; i < n; ++i)
      {
        _lines.next_in("Elements");
        Msh::Element element{};
        element.tag = _lines.whole("an element's number");
        element.entity = entity;
        if (dimension == 1 or dimension == 2)
          element.groups = _groups[dimension][entity];
        read_element(std::move(element), type);
      }
    }
    if (read != total)
      _lines.fail(
          std::format("{} elements, but {} were announced", read, total));
  }

  void skip(const std::string& name)
  {
    while (_lines.next())
      if (_lines.line() == "$End" + name)
        return;
    throw Broken{"is cut off before $End" + name, 0};
  }

  Lines _lines;
  Msh& _out;
  int _major = 0;
  Groups _groups[3]; ///< of entities, by dimension
};
} // namespace

Msh read_msh(std::istream& text, const std::string& file,
             std::vector<scene::Complaint>& complaints)
{
  Msh out;
  try
  {
    Reader(text, out).read();
  }
  catch (const Broken& broken)
  {
    complaints.push_back({"", broken.what, {file, broken.line}});
  }
  return out;
}
} // namespace mmale::mesh
