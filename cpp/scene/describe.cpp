// SPDX-License-Identifier: LGPL-3.0-or-later
#include "scene/describe.h"
#include "scene/writer.h"

namespace mmale::scene
{
std::string describe(Scene scene)
{
  Json json = Json::object();
  Writer writer(json);
  keys(writer, scene);
  return json.dump(2);
}
} // namespace mmale::scene
