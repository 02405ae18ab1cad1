#include "view/page.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <nlohmann/json.hpp>

#include "radar/displacement.h"
#include "view/cut.h"
#include "view/page_text.h"
#include "view/round_sensors.h"
#include "workloads/answer_fields.h"
#include "workloads/query_fields.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

using Json = nlohmann::ordered_json;

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * (bytes.size() + 2) / 3);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// {"f4": "..."}, as data.js reads it.
template <class Value>
Json array(const std::vector<Value>& values) {
  static_assert(std::endian::native == std::endian::little);
  const char* type = std::is_same_v<Value, float>      ? "f4"
                     : std::is_same_v<Value, double>   ? "f8"
                     : std::is_same_v<Value, uint32_t> ? "u4"
                                                       : "u1";
  return {{type, base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)})}};
}

/// Things in a row, each with a mesh and a pose.
struct Poses {
  std::vector<uint32_t> mesh;
  std::vector<float> linear;  // nine a pose, by rows
  std::vector<double> at;     // three a pose

  void add(uint32_t meshNumber, const Transform& pose) {
    mesh.push_back(meshNumber);
    for (size_t i = 0; i < 12; ++i) {
      if (i % 4 == 3) {
        at.push_back(pose.m[i]);
      } else {
        linear.push_back(static_cast<float>(pose.m[i]));
      }
    }
  }
  Json json() const { return {{"mesh", array(mesh)}, {"linear", array(linear)}, {"at", array(at)}}; }
};

/// `isRound`: a sensor that a radius or clearance makes a ball or capsule, as what it is drawn.
Json meshJson(const MeshData& mesh, const MeshData* box, bool isRound = false) {
  const MeshData& shown = box ? *box : mesh;
  return {{"name", mesh.name},
          {"triangles", mesh.triangleCount()},
          {"isBox", box != nullptr},
          {"isRound", isRound},
          {"radius", mesh.radius},
          {"parts", mesh.cutter.parts.size()},
          {"positions", array(shown.positions)},
          {"indices", array(shown.indices)}};
}

MeshData boxOf(const MeshData& mesh) {
  Vec3 lo = INFINITY * kFull, hi = -1 * lo;
  for (const uint32_t vertex : mesh.indices) {
    for (size_t k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], double{mesh.positions[3 * vertex + k]});
      hi[k] = std::max(hi[k], double{mesh.positions[3 * vertex + k]});
    }
  }
  MeshData box = makeBox(hi - lo);
  for (size_t i = 0; i < box.positions.size(); ++i) {
    box.positions[i] += static_cast<float>(0.5 * (lo[i % 3] + hi[i % 3]));
  }
  return box;
}

Json sceneJson(const Workload& workload, uint32_t number, Cut& cut) {
  const SceneSpec& scene = workload.scenes[number];
  const auto first = static_cast<uint32_t>(workload.baseOf(number).size());
  Poses poses;
  std::vector<uint32_t> numbers;
  Json names = Json::object();
  if (cut.hasScene(number)) {
    for (const uint32_t i : cut.objects(number, first)) {
      poses.add(scene.instances[i].mesh, scene.instances[i].worldFromMesh);
      numbers.push_back(first + i);
    }
  }
  const std::vector<std::string> all = workload.objectNames(number);
  for (size_t i = 0; i < all.size(); ++i) {
    if (!all[i].empty()) names[std::to_string(i)] = all[i];
  }
  std::vector<uint32_t> moving;
  std::vector<double> ways;
  for (const auto& [object, way] : scene.motions) {
    moving.push_back(object);
    ways.insert(ways.end(), way.begin(), way.end());
  }
  Json deforms = Json::array();
  for (const Deformation& deformed : scene.deforms) {
    if (cut.isBoxed(deformed.mesh)) continue;
    deforms.push_back({{"mesh", deformed.mesh}, {"positions", array(deformed.positions)}});
  }
  Json json = poses.json();
  json["number"] = array(numbers);
  json["id"] = scene.id;
  json["base"] = scene.base ? Json(*scene.base) : Json(nullptr);
  json["names"] = std::move(names);
  json["moving"] = array(moving);
  json["ways"] = array(ways);
  json["deforms"] = std::move(deforms);
  return json;
}

Json chainJson(const ChainSpec& chain) {
  static constexpr const char* kJoints[] = {"fixed", "revolute", "prismatic"};
  Json links = Json::array();
  for (size_t i = 0; i < chain.links.size(); ++i) {
    const Link& link = chain.links[i];
    Json meshes = Json::array();
    for (const LinkMesh& mesh : link.meshes) meshes.push_back({{"mesh", mesh.mesh}, {"pose", mesh.linkFromMesh.m}});
    links.push_back({{"name", chain.linkNames[i]},
                     {"parent", link.parent == kNone ? Json(nullptr) : Json(link.parent)},
                     {"origin", link.parentFromJoint.m},
                     {"joint", kJoints[static_cast<size_t>(link.joint)]},
                     {"axis", link.axis},
                     {"variable", link.variable},
                     {"meshes", std::move(meshes)}});
  }
  return {{"links", std::move(links)}};
}

/// Objects that take no part in a query: excluded, or without a bit of its mask.
std::vector<uint32_t> ignoredBy(const QuerySpec& query, const SceneSpec& scene) {
  std::vector<uint32_t> ignored = query.exclude;
  for (const auto& [object, bits] : scene.masks) {
    if ((bits & query.mask) == 0) ignored.push_back(object);
  }
  return ignored;
}

/// The options that a query gives, but lists of objects: {"clearance": 0.5, "hits": "all", "ignore_leaving": true}. The
/// clearance is what it asks for beside the radius of its mesh.
Json askedJson(QuerySpec query, double radius) {
  query.clearance -= radius;
  Json asked = Json::object();
  for (const QueryField& field : queryFields()) {
    if (field.kind() == 'o' || !isGiven(query, field)) continue;
    const double value = valueIn(query, field);
    Json& json = asked[field.name];
    if (field.kind() == 'b') {
      json = value != 0;
    } else if (field.word && std::isinf(value)) {
      json = field.word;
    } else {
      json = value;
    }
  }
  return asked;
}

Json queriesJson(const Workload& workload, std::span<const QuerySpec> queries, const RoundSensors& round) {
  Poses poses;
  Json ignored = Json::object(), asked = Json::object(), turns = Json::object(), moves = Json::object();
  Json ids = Json::array();
  std::vector<uint32_t> scenes;
  std::vector<double> ways, wholes;
  std::vector<uint8_t> steps;
  for (const QuerySpec& query : queries) {
    const std::array<double, 3> way = query.chain ? std::array<double, 3>{} : displacementOf(query);
    const std::string number = std::to_string(scenes.size());
    const Instance& sensor = round.sensors[scenes.size()];
    poses.add(sensor.mesh, sensor.worldFromMesh);
    if (const std::optional<ChainWay>& chain = query.chain) {
      moves[number] = {
          {"chain", chain->chain}, {"from", chain->from}, {"to", chain->to}, {"base", query.worldFromMesh.m}};
    }
    ids.push_back(query.id);
    scenes.push_back(query.scene);
    ways.insert(ways.end(), way.begin(), way.end());
    wholes.push_back(takesStep(query) ? 1 : query.distance);
    steps.push_back(takesStep(query));
    if (query.turn)
      turns[number] = {{"axis", query.turn->axis}, {"angle", query.turn->angle}, {"centre", query.turn->centre}};
    const std::vector<uint32_t> left = ignoredBy(query, workload.scenes[query.scene]);
    if (!left.empty()) ignored[number] = left;
    Json options = askedJson(query, query.chain ? 0 : workload.meshes[query.mesh].radius);
    if (!options.empty()) asked[number] = std::move(options);
  }
  Json json = poses.json();
  json["count"] = queries.size();
  json["id"] = std::move(ids);
  json["scene"] = array(scenes);
  json["way"] = array(ways);
  json["whole"] = array(wholes);
  json["step"] = array(steps);
  json["turns"] = std::move(turns);
  json["moves"] = std::move(moves);
  json["asked"] = std::move(asked);
  json["ignored"] = std::move(ignored);
  return json;
}

/// By member. Of a step, times are fractions.
Json answersJson(std::span<const Result> answers, std::span<const LinksMet> links = {}) {
  const Query unasked;
  Json json = Json::object();
  for (const AnswerField& field : answerFields()) {
    if (!field.page || (field.line == When::chain && links.empty())) continue;
    std::vector<double> values;
    for (size_t i = 0; i < answers.size(); ++i) {
      const std::optional<LinksMet> met = links.empty() ? std::nullopt : std::optional(links[i]);
      const AnswerRow row(unasked, answers[i], AnswerMode::contact, {}, 0, met);
      for (size_t part = 0; part < field.width; ++part) values.push_back(field.value(row, part));
    }
    if (field.isReal()) {
      json[field.name] = array(values);
    } else if (!field.words.empty()) {
      json[field.name] = array(std::vector<uint8_t>(values.begin(), values.end()));
    } else {
      std::vector<uint32_t> ids;
      for (const double value : values) ids.push_back(std::isnan(value) ? kNone : static_cast<uint32_t>(value));
      json[field.name] = array(ids);
    }
  }
  return json;
}

/// The moments in lists, one after the other; "first": where those of each query begin, and at last their number; "as":
/// what each is.
Json momentsJson(const ListedMoments& lists, size_t queries, size_t listing) {
  std::vector<Result> all;
  std::vector<uint32_t> first;
  std::vector<uint8_t> as;
  for (uint32_t i = 0; i < queries; ++i) {
    first.push_back(static_cast<uint32_t>(all.size()));
    const auto found = lists.find(i);
    if (i >= listing || found == lists.end()) continue;
    for (const ListedMoment& moment : found->second) {
      all.push_back(moment.result);
      as.push_back(static_cast<uint8_t>(moment.as));
    }
  }
  first.push_back(static_cast<uint32_t>(all.size()));
  Json json = answersJson(all);
  json["first"] = array(first);
  json["as"] = array(as);
  return json;
}

Json scopesJson(const Scopes& scopes) {
  return {{"width", scopes.width},   {"height", scopes.height}, {"pixel", scopes.pixel}, {"d", scopes.d},
          {"length", scopes.length}, {"R", array(scopes.R)},    {"M", array(scopes.M)},  {"L", array(scopes.L)},
          {"origin", scopes.origin}, {"right", scopes.right},   {"up", scopes.up},       {"forward", scopes.forward}};
}

Json otherJson(const OtherAnswer& other) {
  // A number that JSON does not have becomes null.
  return {{"words", other.words}, {"t", other.result.t}, {"object", other.result.object}};
}

/// An object with an entry for each query that the map names, made by `json`.
template <class Value, class Make>
Json byQuery(const std::map<uint32_t, Value>& entries, size_t queries, const Make& json) {
  Json object = Json::object();
  for (const auto& [query, value] : entries) {
    if (query < queries) object[std::to_string(query)] = json(value);
  }
  return object;
}

}  // namespace

std::string pageOf(const Workload& workload, std::span<const Result> answers, const PageContent& content) {
  Cut cut(workload, answers, content.left, std::max<uint64_t>(content.queries, workload.queries.size()),
          content.moments);
  cut.boxMeshes();
  const size_t count = cut.queries();
  const auto asItIs = [](const std::string& text) { return text; };
  Json json;
  json["title"] = content.title;
  json["statuses"] = findAnswerField("status")->words;
  json["none"] = kNone;
  json["meshes"] = Json::array();
  for (size_t i = 0; i < workload.meshes.size(); ++i) {
    const MeshData& mesh = workload.meshes[i];
    std::optional<MeshData> box;
    if (cut.isBoxed(i)) box = boxOf(mesh);
    json["meshes"].push_back(meshJson(mesh, box ? &*box : nullptr));
  }
  const std::span<const QuerySpec> queries = std::span(workload.queries).first(count);
  const RoundSensors round(workload, queries);
  for (const MeshData& mesh : round.meshes) json["meshes"].push_back(meshJson(mesh, nullptr, true));
  json["chains"] = Json::array();
  for (const ChainSpec& chain : workload.chains) json["chains"].push_back(chainJson(chain));
  json["scenes"] = Json::array();
  for (uint32_t i = 0; i < workload.scenes.size(); ++i) json["scenes"].push_back(sceneJson(workload, i, cut));
  json["queries"] = queriesJson(workload, queries, round);
  json["answers"] = answersJson(answers.first(count), content.links);
  json["moments"] = momentsJson(content.moments, count, cut.listing());
  json["left"] = byQuery(content.left, count, [](const std::vector<uint32_t>& objects) { return objects; });
  json["reasons"] = byQuery(content.reasons, count, asItIs);
  json["others"] = byQuery(content.others, count, otherJson);
  json["scopes"] = byQuery(content.scopes, count, scopesJson);
  json["tour"] = Json::array();
  if (content.tour) json["tour"] = {{{"query", *content.tour}, {"play", "alone"}}, {{"play", "all"}}};
  json["notes"] = cut.notes();

  // No text of the data can end the element that holds it.
  std::string page = kPageBefore;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') {
      page += "\\u003c";
    } else {
      page += c;
    }
  }
  return page + kPageAfter;
}

}  // namespace radar::tools
