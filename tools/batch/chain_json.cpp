#include "batch/chain_json.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "batch/query_json.h"

namespace radar::tools {

namespace {

constexpr const char* kJoints[] = {"fixed", "revolute", "prismatic"};

/// Where a name stands; refuses one that is not there.
uint32_t numberOf(const JsonValue& name, std::span<const std::string> among, const char* what) {
  const auto found = std::ranges::find(among, name.string());
  if (found == among.end()) name.expected(what);
  return static_cast<uint32_t>(found - among.begin());
}

/// What the engine says of a member, "name: what is wrong", in the words of the file.
void refuseMember(const JsonValue& object, const std::string& wrong,
                  std::initializer_list<std::pair<const char*, const char*>> names) {
  const size_t colon = wrong.find(": ");
  std::string member = wrong.substr(0, colon);
  for (const auto& [engine, file] : names) {
    if (member == engine) member = file;
  }
  object.member(member.c_str()).refuse(wrong.substr(colon + 2));
}

/// Reads one chain.
class ChainReader {
 public:
  ChainReader(const Workload& world, std::span<const std::array<double, 3>> bases) : world_(world), bases_(bases) {}

  ChainSpec read(const JsonValue& value) {
    requireKnownKeys(value, {"links", "pairs", "ignored"});
    value.member("links").forEach([&](const JsonValue& link) { readLink(link); });
    chain_.variables = static_cast<uint32_t>(chain_.variableNames.size());
    chain_.pairs = apart();
    value.ifHas("pairs", [&](const JsonValue& list) { chain_.pairs = pairsIn(list); });
    value.ifHas("ignored", [&](const JsonValue& list) {
      for (const auto& [a, b] : pairsIn(list)) {
        std::erase(chain_.pairs, Pair{a, b});
        std::erase(chain_.pairs, Pair{b, a});
      }
    });
    Chain bare = chain_;
    for (Link& link : bare.links) link.meshes.clear();
    if (const std::string wrong = validate(bare, Scene()); !wrong.empty()) value.refuse(wrong);
    return std::move(chain_);
  }

 private:
  using Pair = std::array<uint32_t, 2>;

  void readLink(const JsonValue& value) {
    requireKnownKeys(value, {"name", "parent", "joint", "origin", "axis", "variable", "meshes"});
    const JsonValue name = value.member("name");
    if (std::ranges::count(chain_.linkNames, name.string()) > 0) name.expected("a name that no other link has");
    Link link;
    value.ifHas("parent", [&](const JsonValue& parent) {
      link.parent = numberOf(parent, chain_.linkNames, "the name of a link before it");
    });
    value.ifHas("joint", [&](const JsonValue& joint) {
      const auto* const found = std::ranges::find(kJoints, joint.string());
      if (found == std::end(kJoints)) joint.expected("\"fixed\", \"revolute\" or \"prismatic\"");
      link.joint = static_cast<JointType>(found - kJoints);
    });
    value.ifHas("origin", [&](const JsonValue& origin) { link.parentFromJoint = poseFrom(origin); });
    for (const char* key : {"axis", "variable"}) {
      if (link.joint == JointType::fixed && value.has(key)) value.member(key).refuse("expected none of a fixed joint");
    }
    value.ifHas("axis", [&](const JsonValue& axis) { link.axis = vectorFrom(axis); });
    if (link.joint != JointType::fixed)
      link.variable = variableOf(value.has("variable") ? value.member("variable") : name);
    value.ifHas("meshes", [&](const JsonValue& meshes) {
      meshes.forEach([&](const JsonValue& list) { link.meshes.push_back(meshFrom(list)); });
    });
    checkAlone(value, link);
    chain_.links.push_back(std::move(link));
    chain_.linkNames.push_back(name.string());
  }

  uint32_t variableOf(const JsonValue& name) {
    std::vector<std::string>& names = chain_.variableNames;
    const auto found = std::ranges::find(names, name.string());
    if (found != names.end()) return static_cast<uint32_t>(found - names.begin());
    names.push_back(name.string());
    return static_cast<uint32_t>(names.size() - 1);
  }

  LinkMesh meshFrom(const JsonValue& list) const {
    const Instance placed = instanceFrom(list, bases_);
    if (const std::string wrong = onlySensor(world_.meshes[placed.mesh]); !wrong.empty()) list[0].refuse(wrong);
    for (const double value : placed.worldFromMesh.m) {
      if (std::abs(value) > 0x1p300) list.expected("numbers of at most 2^300");
    }
    return {placed.mesh, placed.worldFromMesh};
  }

  /// What the engine says of the joint.
  static void checkAlone(const JsonValue& value, const Link& link) {
    Chain alone{.links = {link}, .variables = 1};
    alone.links[0].parent = kNone;
    alone.links[0].variable = 0;
    alone.links[0].meshes.clear();
    const std::string wrong = validate(alone, Scene()), before = "link 0: ";
    if (!wrong.empty()) refuseMember(value, wrong.substr(before.size()), {{"parentFromJoint", "origin"}});
  }

  std::vector<Pair> pairsIn(const JsonValue& list) const {
    std::vector<Pair> pairs;
    list.forEach([&](const JsonValue& pair) {
      if (pair.size() != 2 || pair.json()[0] == pair.json()[1]) pair.expected("the names of two links");
      Pair& found = pairs.emplace_back();
      for (size_t k = 0; k < 2; ++k) found[k] = numberOf(pair[k], chain_.linkNames, "the name of a link");
    });
    return pairs;
  }

  /// All links that have meshes, but for those that do not move past each other, or do so at one joint.
  std::vector<Pair> apart() const {
    std::vector<uint32_t> groups;  // of links that are fixed to each other: the first of them; kNone: to the base
    std::set<Pair> joined;
    for (uint32_t i = 0; i < chain_.links.size(); ++i) {
      const Link& link = chain_.links[i];
      const uint32_t before = link.parent == kNone ? kNone : groups[link.parent];
      groups.push_back(link.joint == JointType::fixed ? before : i);
      joined.insert({std::min(before, groups[i]), std::max(before, groups[i])});
    }
    std::vector<Pair> pairs;
    for (uint32_t a = 0; a < groups.size(); ++a) {
      for (uint32_t b = a + 1; b < groups.size(); ++b) {
        if (chain_.links[a].meshes.empty() || chain_.links[b].meshes.empty()) continue;
        if (joined.contains({std::min(groups[a], groups[b]), std::max(groups[a], groups[b])})) continue;
        pairs.push_back({a, b});
      }
    }
    return pairs;
  }

  const Workload& world_;
  std::span<const std::array<double, 3>> bases_;
  ChainSpec chain_;
};

}  // namespace

ChainSpec chainFrom(const JsonValue& value, const Workload& world, std::span<const std::array<double, 3>> bases) {
  return ChainReader(world, bases).read(value);
}

void readChainWay(const JsonValue& query, const Workload& world, QuerySpec& to) {
  ChainWay& way = to.chain.emplace();
  way.chain = query.member("chain").index(world.chains.size(), "chains");
  query.member("from").forEach([&](const JsonValue& number) { way.from.push_back(number.number()); });
  query.member("to").forEach([&](const JsonValue& number) { way.to.push_back(number.number()); });
  query.ifHas("base", [&](const JsonValue& base) { to.worldFromMesh = poseFrom(base); });
  to.mesh = kNone;
  to.mode = AnswerMode::reference;
}

void checkChainQuery(const JsonValue& query, const Workload& world, const QuerySpec& spec) {
  ChainQuery asked = chainQueryOf(spec);
  asked.exclude.clear();
  const std::string wrong = validate(asked, world.chains[spec.chain->chain], Scene());
  if (!wrong.empty()) refuseMember(query, wrong, {{"worldFromBase", "base"}});
}

}  // namespace radar::tools
