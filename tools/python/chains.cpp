#include "python/chains.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "python/arrays.h"
#include "python/errands.h"
#include "python/page.h"
#include "python/signals.h"
#include "radar/chain.h"
#include "view/page.h"

namespace radar::python {

namespace {

/// An answer in an array of numpy's. Absent ids are -1.
struct MoveRecord {
  double fraction, lo, hi;
  std::array<double, 3> point, normal;
  double gap;
  int64_t link, mesh, object, otherLink, otherMesh, triA, triB;
  uint8_t status, featureA, featureB;
};

// Motions that are asked about at once, which bounds the memory for them.
constexpr size_t kChunk = 1 << 14;

// As _engine.pyi has them.
using MeshTuple = std::tuple<MeshId, Array<double>>;
using LinkTuple = std::tuple<std::optional<uint32_t>, Array<double>, uint32_t, std::array<double, 3>,
                             std::optional<uint32_t>, std::vector<MeshTuple>>;
using ChainTuple = std::tuple<std::vector<LinkTuple>, uint32_t, std::vector<std::array<uint32_t, 2>>>;

Transform poseFrom(const Array<double>& matrix) {
  requireCount(matrix, "pose", 16);
  return transformFrom(matrix.data());
}

Chain chainFrom(const BasedScene& scene, const ChainTuple& given) {
  const auto& [links, variables, pairs] = given;
  Chain chain{.variables = variables, .pairs = pairs};
  for (const auto& [parent, origin, joint, axis, variable, meshes] : links) {
    Link& link = chain.links.emplace_back();
    link.parent = parent.value_or(kNone);
    link.parentFromJoint = poseFrom(origin);
    link.joint = static_cast<JointType>(joint);
    link.axis = axis;
    link.variable = variable.value_or(kNone);
    for (const auto& [mesh, pose] : meshes) link.meshes.push_back({mesh, scene.placed(mesh, poseFrom(pose))});
  }
  return chain;
}

int64_t idOf(uint32_t id) {
  return id == kNone ? -1 : int64_t{id};
}

MoveRecord recordOf(const ChainResult& answer) {
  const Result& found = answer.contact;
  const bool isOpen = found.status == Status::undecided;  // nobody knows when
  return {.fraction = isOpen ? std::numeric_limits<double>::quiet_NaN() : found.t,
          .lo = found.lo,
          .hi = found.hi,
          .point = found.point,
          .normal = found.normal,
          .gap = found.gap,
          .link = idOf(answer.link),
          .mesh = idOf(answer.mesh),
          .object = idOf(found.object),
          .otherLink = idOf(answer.otherLink),
          .otherMesh = idOf(answer.otherMesh),
          .triA = idOf(found.triA),
          .triB = idOf(found.triB),
          .status = static_cast<uint8_t>(found.status),
          .featureA = static_cast<uint8_t>(found.featureA),
          .featureB = static_cast<uint8_t>(found.featureB)};
}

tools::LinksMet linksOf(const MoveRecord& record) {
  return {static_cast<uint32_t>(record.link), static_cast<uint32_t>(record.mesh),
          static_cast<uint32_t>(record.otherLink), static_cast<uint32_t>(record.otherMesh)};
}

/// What a page shows of it.
Result resultOf(const MoveRecord& record) {
  Result result(static_cast<Status>(record.status));
  result.t = std::isnan(record.fraction) ? record.lo : record.fraction;
  result.lo = record.lo;
  result.hi = record.hi;
  result.point = record.point;
  result.normal = record.normal;
  result.gap = record.gap;
  result.object = static_cast<uint32_t>(record.object);
  result.triA = static_cast<uint32_t>(record.triA);
  result.triB = static_cast<uint32_t>(record.triB);
  return result;
}

/// A query's broken contract in the words of the arguments; empty if it is kept.
std::string wrongWith(const ChainQuery& query, const Chain& chain, const Scene& scene) {
  std::string wrong = validate(query, chain, scene);
  for (const auto& [engine, argument] :
       {std::pair{"from: ", "start: "}, std::pair{"to: ", "end: "}, std::pair{"worldFromBase: ", "base: "}}) {
    if (wrong.starts_with(engine)) return argument + wrong.substr(std::strlen(engine));
  }
  return wrong;
}

/// What is asked of all motions, and of each.
struct Motions {
  ChainQuery ofAll;
  const double *starts, *ends;  ///< a row for each
  const double* bases;          ///< 16 numbers, for each or for all
  bool hasBases;                ///< for each
  size_t count;
};
using Reasons = std::map<std::string, std::vector<int64_t>>;

/// Why some are invalid, and which.
Reasons answer(ChainSweeper& sweeper, const Scene& scene, const Motions& asked, const std::function<void()>& look,
               MoveRecord* records) {
  Reasons reasons;
  const size_t width = sweeper.chain().variables;
  std::vector<double> starts, ends;  // copies, as other threads may write to the arrays
  std::vector<ChainQuery> queries;
  std::vector<size_t> numbers;
  for (size_t first = 0; first < asked.count; first += kChunk) {
    const size_t count = std::min(kChunk, asked.count - first);
    starts.assign(asked.starts + width * first, asked.starts + width * (first + count));
    ends.assign(asked.ends + width * first, asked.ends + width * (first + count));
    queries.resize(count, asked.ofAll);
    numbers.clear();
    for (size_t i = 0; i < count; ++i) {
      ChainQuery& query = queries[numbers.size()];
      query.from = std::span(starts).subspan(width * i, width);
      query.to = std::span(ends).subspan(width * i, width);
      query.worldFromBase = transformFrom(asked.bases + (asked.hasBases ? 16 * (first + i) : 0));
      records[first + i] = recordOf({});
      if (const std::string wrong = wrongWith(query, sweeper.chain(), scene); !wrong.empty()) {
        reasons[wrong].push_back(static_cast<int64_t>(first + i));
      } else {
        numbers.push_back(first + i);
      }
    }
    std::vector<ChainResult> results;
    runUnless(look, [&](const std::stop_token& stop) {
      results = sweeper.run(std::span(queries).first(numbers.size()), stop);
    });
    for (size_t i = 0; i < numbers.size(); ++i) records[numbers[i]] = recordOf(results[i]);
  }
  return reasons;
}

/// What _engine.pyi says of move_chain().
py::tuple moveChain(CastingScene& scene, const ChainTuple& chain, const Array<double>& starts,
                    const Array<double>& ends, const Array<double>& bases, const std::vector<ObjectId>& excluded,
                    const py::dict& options) {
  const auto count = static_cast<size_t>(starts.shape(0));
  const size_t width = std::get<1>(chain);
  requireCount(starts, "start", width * count);
  requireCount(ends, "end", width * count);
  const bool hasBases = bases.ndim() > 2;
  requireCount(bases, "base", hasBases ? 16 * count : 16);
  const Motions asked{.ofAll = {.anyHit = options["any_hit"].cast<bool>(),
                                .exclude = excluded,
                                .mask = options["mask"].cast<uint32_t>(),
                                .clearance = options["clearance"].cast<double>(),
                                .tolerance = options["tolerance"].cast<std::optional<double>>()},
                      .starts = starts.data(),
                      .ends = ends.data(),
                      .bases = bases.data(),
                      .hasBases = hasBases,
                      .count = count};
  Chain made = chainFrom(scene.based(), chain);
  Array<MoveRecord> records(starts.shape(0));
  MoveRecord* const to = records.mutable_data();
  const std::function<void()> heedSignals = signalsHeeded();
  const Reasons found = released([&] {
    ChainSweeper sweeper(scene.scene(), std::move(made), scene.threads());
    return answer(sweeper, scene.scene(), asked, heedSignals, to);
  });
  py::dict reasons;
  for (const auto& [reason, which] : found) {
    reasons[py::str(reason)] = arrayOf(which, {py::ssize_t(which.size())});
  }
  return py::make_tuple(records, reasons);
}

/// What _engine.pyi says of moves_page().
std::string movesPage(const CastingScene& scene, const std::map<uint32_t, std::string>& objectNames,
                      const ChainTuple& chain, const std::vector<std::string>& linkNames,
                      const std::vector<ObjectId>& excluded, const py::dict& options, const std::string& title,
                      uint64_t count, const std::vector<std::string>& names, const py::dict& arrays,
                      const Array<MoveRecord>& records, const std::map<uint32_t, std::string>& reasons) {
  const size_t shown = names.size(), width = std::get<1>(chain);
  const auto *const starts = numbers<double>(arrays, "start", width * shown),
                    *const ends = numbers<double>(arrays, "end", width * shown),
                    *const bases = numbers<double>(arrays, "base", 16 * shown);
  requireCount(records, "records", shown);
  tools::Workload workload = workloadOf(scene.based(), objectNames);
  workload.chains.push_back({chainFrom(scene.based(), chain), linkNames, {}});
  std::vector<Result> results;
  tools::PageContent content{.title = title, .queries = count, .reasons = reasons};
  for (size_t i = 0; i < shown; ++i) {
    tools::QuerySpec& query = workload.queries.emplace_back();
    query.id = names[i];
    query.mesh = kNone;
    query.worldFromMesh = transformFrom(bases + 16 * i);
    query.chain = {0, {starts + width * i, starts + width * (i + 1)}, {ends + width * i, ends + width * (i + 1)}};
    query.exclude = excluded;
    query.anyHit = options["any_hit"].cast<bool>();
    query.mask = options["mask"].cast<uint32_t>();
    query.clearance = options["clearance"].cast<double>();
    query.tolerance = options["tolerance"].cast<std::optional<double>>();
    results.push_back(resultOf(records.data()[i]));
    content.links.push_back(linksOf(records.data()[i]));
  }
  return tools::pageOf(workload, results, content);
}

}  // namespace

void defineChains(py::module_& module, py::class_<CastingScene>& scene) {
  PYBIND11_NUMPY_DTYPE_EX(MoveRecord, fraction, "fraction", lo, "fraction_lo", hi, "fraction_hi", status, "status",
                          link, "link", mesh, "mesh", object, "object", otherLink, "other_link", otherMesh,
                          "other_mesh", triA, "tri_a", triB, "tri_b", featureA, "feature_a", featureB, "feature_b",
                          point, "point", normal, "normal", gap, "gap");
  module.attr("MOVES") = py::dtype::of<MoveRecord>();
  scene.def("wrong_with_chain", [](const CastingScene& of, const ChainTuple& chain) {
    return validate(chainFrom(of.based(), chain), of.scene());
  });
  scene.def("move_chain", &moveChain).def("moves_page", &movesPage);
}

}  // namespace radar::python
