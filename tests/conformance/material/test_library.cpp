// SPDX-License-Identifier: LGPL-3.0-or-later
// What the list of laws offers to scenes.
#include "samples.h"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <set>

using namespace mmale;
using namespace mmale::material;
using Catch::Matchers::ContainsSubstring;
using mmale::test::Sample;

namespace
{
auto any_sample()
{
  return GENERATE_REF(from_range(test::samples));
}
} // namespace

TEST_CASE("every law of the list has a sample in these tests",
          "[conformance][material]")
{
  std::set<std::string> sampled;
  for (const Sample& s : test::samples)
    sampled.insert(s.law());
  for (const auto& info : law_infos())
  {
    INFO("add a set of parameters of '" << info.name << "' to samples.h");
    CHECK(sampled.contains(info.name));
  }
}

TEST_CASE("no parameter passes as NaN, all have units and sentences",
          "[conformance][material]")
{
  for (const auto& info : law_infos())
    for (const auto& parameter : info.parameters)
    {
      INFO(info.name << "." << parameter.name);
      CHECK_FALSE(parameter.range.holds(std::nan("")));
      CHECK_FALSE(parameter.range.holds(scene::infinity));
      CHECK_FALSE(parameter.unit.empty());
      CHECK_FALSE(parameter.sentence.empty());
      if (std::isfinite(parameter.standard))
        CHECK(parameter.range.holds(parameter.standard));
    }
}

TEST_CASE("the samples' parameters are complete, in range and without "
          "complaints",
          "[conformance][material]")
{
  const Sample sample = any_sample();
  INFO("law " << sample.law());
  for (const auto& info : law_infos())
    if (info.name == sample.law())
      for (const auto& parameter : info.parameters)
      {
        INFO(parameter.name);
        const auto& given = sample.material.parameters;
        const bool by_set = sample.material.texts.contains(info.set_key);
        if (parameter.is_required() and not by_set)
          REQUIRE(given.contains(parameter.name));
        if (given.contains(parameter.name))
          CHECK(parameter.range.holds(given.at(parameter.name)));
      }
  const AnyLaw law = make_law(sample.material);
  if (sample.law() != "void") // which complains of being alone in a scene
    CHECK(
        std::visit([](const auto& l) { return l.complaints(); }, law).empty());
}

TEST_CASE("every parameter set makes a law without complaints, and says its "
          "source",
          "[conformance][material]")
{
  for (const auto& info : law_infos())
    for (const auto& set : info.sets)
    {
      INFO(info.name << " " << set.name);
      CHECK_FALSE(set.source.empty());
      for (const auto& [name, value] : set.values)
      {
        const auto parameter = std::ranges::find(info.parameters, name,
                                                 &scene::ParameterInfo::name);
        REQUIRE(parameter != info.parameters.end());
        CHECK(parameter->range.holds(value));
      }
    }
}

TEST_CASE("an unknown law or parameter is named", "[conformance][material]")
{
  CHECK_THROWS_WITH(make_law({.law = "jelly"}), ContainsSubstring("jelly"));
  for (const auto& info : law_infos())
  {
    CHECK_THROWS_WITH(
        make_law({.law = info.name, .parameters = {{"sweetness", 1.0}}}),
        ContainsSubstring("sweetness") and ContainsSubstring(info.name));
    CHECK_THROWS_WITH(
        make_law({.law = info.name, .texts = {{"colour", "red"}}}),
        ContainsSubstring("colour") and ContainsSubstring(info.name));
  }
}
