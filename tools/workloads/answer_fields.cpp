#include "workloads/answer_fields.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "radar/displacement.h"

namespace radar::tools {

namespace {

constexpr double kNull = std::numeric_limits<double>::quiet_NaN();

#define RADAR_CODE(name, value) #name,
constexpr const char* kStatuses[] = {RADAR_STATUSES(RADAR_CODE)};
constexpr const char* kTiers[] = {RADAR_TIERS(RADAR_CODE)};
constexpr const char* kFeatures[] = {RADAR_FEATURES(RADAR_CODE)};
#undef RADAR_CODE
constexpr const char* kTruths[] = {"false", "true"};

template <auto member>
double valueOf(const AnswerRow& row, size_t part) {
  const auto& value = row.result.*member;
  using Value = std::remove_cvref_t<decltype(value)>;
  if constexpr (std::is_same_v<Value, std::array<double, 3>>) {
    return std::isnan(value[0]) ? kNull : value[part];
  } else if constexpr (std::is_same_v<Value, Detected>) {
    return value == Detected::notLooked ? kNull : double(value == Detected::yes);
  } else {
    return static_cast<double>(value);
  }
}

template <auto member>
double idOf(const AnswerRow& row, size_t) {
  return row.result.*member == kNone ? kNull : row.result.*member;
}

/// Of an answer that leaves it open whether there is a contact, nobody knows when.
template <auto member>
double timeOf(const AnswerRow& row, size_t) {
  return row.result.status == Status::undecided ? kNull : row.result.*member;
}

template <uint32_t LinksMet::*member>
double linkOf(const AnswerRow& row, size_t) {
  return !row.links || *row.links.*member == kNone ? kNull : *row.links.*member;
}

template <auto member>
void set(Result& to, double value, size_t part) {
  if (std::isnan(value)) return;
  auto& place = to.*member;
  using Value = std::remove_reference_t<decltype(place)>;
  if constexpr (std::is_same_v<Value, std::array<double, 3>>) {
    place[part] = value;
  } else if constexpr (std::is_same_v<Value, Detected>) {
    place = value == 0 ? Detected::no : Detected::yes;
  } else if constexpr (std::is_enum_v<Value>) {
    place = static_cast<Value>(static_cast<uint32_t>(value));
  } else {
    place = static_cast<Value>(value);
  }
}

/// The sensor's point that is nearest to the touched surface.
double sensorPoint(const AnswerRow& row, size_t part) {
  const Result& result = row.result;
  if (std::isnan(result.gap)) return kNull;
  return std::isnan(result.normal[0]) ? result.point[part] : result.point[part] + result.gap * result.normal[part];
}

constexpr AnswerType kIndex{"<u8"}, kReal{"<f8"}, kVector{"<f8", 3}, kId{"<i8"}, kCount{"<u4"},
    kTruth{"|i1", 1, kTruths}, kStatus{"|u1", 1, kStatuses}, kTier{"|u1", 1, kTiers}, kFeature{"|u1", 1, kFeatures};
template <auto member>
constexpr AnswerAccess kMember{valueOf<member>, set<member>};
template <auto member>
constexpr AnswerAccess kIdOf{idOf<member>, set<member>};
template <auto member>
constexpr AnswerAccess kTime{timeOf<member>, set<member>};
constexpr AnswerPlaces kOfChain{When::chain, When::never, When::never, true};
constexpr AnswerPlaces kOfAnswer{When::always, When::never, When::always},
    kOfContact{When::always, When::always, When::always, true};
constexpr size_t kNowhere = ~size_t{0};

// In the order of lines.
constexpr AnswerField kFields[] = {
    {{{"query"},
      kIndex,
      {[](const AnswerRow& row, size_t) { return double(row.index); }},
      {When::never, When::never, When::never},
      0},
     "In records only: the query's index."},
    {{{"status"}, kStatus, kMember<&Result::status>, {When::always, When::never, When::always, true}, 152},
     "`hit`: hi <= D. `clear`: certainly no contact within D. `overlap`: the surfaces certainly meet at the start (t = "
     "lo = hi = 0). `undecided`, in mode `sampled`, with a `clearance`, a `turn` or a `chain`: hi is null, lo <= "
     "D. `invalid`: not answered, with a `reason`."},
    {{{"t"}, kReal, kTime<&Result::t>, kOfContact, 8, "fraction"},
     "How far it is to first contact: t*, rounded; in mode `sampled` and with `any_hit`, `hi`; with a "
     "`clearance`, a `turn` or a `chain`, `lo`. Null for `clear` and `undecided`."},
    {{{"lo"}, kReal, kMember<&Result::lo>, kOfContact, 16, "fraction_lo"}, "No contact before this."},
    {{{"hi"}, kReal, kMember<&Result::hi>, kOfContact, 24, "fraction_hi"},
     "t* lies in [lo, hi], certainly. Null: t* is at least lo *or does not exist*. Contact exactly at D has t = hi = "
     "D."},
    {{{"fraction"}, kReal, kTime<&Result::fraction>, {When::always, When::step, When::always}, 32},
     "t / D, or of the step. With `motion`, t, lo and hi are fractions times the motion's length; with `turn` or "
     "`chain`, fractions."},
    {{{"fraction_lo"},
      kReal,
      {[](const AnswerRow& row, size_t) { return row.fractionLo; }},
      {When::step, When::step, When::never},
      40},
     "With `motion`, `turn` or `chain`: the bracket of the fraction."},
    {{{"fraction_hi"},
      kReal,
      {[](const AnswerRow& row, size_t) { return row.fractionHi; }},
      {When::step, When::step, When::never},
      48},
     "Likewise."},
    {{{"time"},
      kReal,
      {[](const AnswerRow& row, size_t) { return row.speed ? row.result.t / *row.speed : kNull; }},
      {When::timed, When::never, When::never},
      56},
     "With `speed`: t / speed, the paper's time of collision."},
    {{{"detected"}, kTruth, kMember<&Result::detected>, kOfAnswer, 156},
     "The paper's first step: whether some surface lies in the target volume (in mode `sampled`: at any pixel's "
     "centre). Null: not determined."},
    {{{"link"}, kId, {linkOf<&LinksMet::link>}, kOfChain, kNowhere},
     "Of a [chain](#chains): the number of its link that touches something; a line has its `link_name`, too. Not in "
     "records."},
    {{{"mesh"}, kId, {linkOf<&LinksMet::mesh>}, kOfChain, kNowhere}, "Which of that link's meshes."},
    {{{"object"}, kId, kIdOf<&Result::object>, kOfContact, 120},
     "The object touched. Among pairs of equal t, the least (object, tri_b, tri_a)."},
    {{{"other_link"}, kId, {linkOf<&LinksMet::otherLink>}, kOfChain, kNowhere},
     "Of a chain: the link that is touched, if it is no object; a line has its `other_link_name`, too."},
    {{{"other_mesh"}, kId, {linkOf<&LinksMet::otherMesh>}, kOfChain, kNowhere}, "Which of that link's meshes."},
    {{{"tri_a"}, kId, kIdOf<&Result::triA>, kOfContact, 128},
     "The triangle of the sensor, or of the link's mesh, that touches it; the part of a cutter, 0 for its end."},
    {{{"tri_b"}, kId, kIdOf<&Result::triB>, kOfContact, 136},
     "The triangle touched, of the object or of the other link's mesh."},
    {{{"feature_a"}, kFeature, kMember<&Result::featureA>, {When::always, When::always, When::always}, 154},
     "The smallest feature of `tri_a` that contains every point at which the triangles touch at that moment, exactly; "
     "with a `clearance`, of the nearest points. Null without contact."},
    {{{"feature_b"}, kFeature, kMember<&Result::featureB>, {When::always, When::always, When::always}, 155},
     "Likewise of `tri_b`."},
    {{{"point"}, kVector, kMember<&Result::point>, kOfContact, 72},
     "World position of the contact *at the moment of contact*; exactly the object's corner where `feature_b` is "
     "`vertex`."},
    {{{"normal"}, kVector, kMember<&Result::normal>, kOfContact, 96},
     "Unit, world, from the touched surface towards the sensor, normal . dir <= 0. Of a hit it keeps the two triangles "
     "apart when they touch, and the surfaces around `point`, if any normal does. Null for starts that cross. With a "
     "`clearance` it may point along `dir` if the surfaces are in contact at the start."},
    {{{"gap"}, kReal, kMember<&Result::gap>, {When::near, When::near, When::always, true}, 144},
     "With a `clearance`: how far apart the two triangles are at `t` or, where another pair lowers `lo`, when they "
     "come within the clearance, as are `point` and `normal`; at the start the least distance."},
    {{{"sensor_point"}, kVector, {sensorPoint}, {When::near, When::near, When::never}, kNowhere},
     "With a `clearance`: the sensor's point that far from `point`, world. Not in records."},
    {{{"tier"}, kTier, kMember<&Result::tier>, kOfAnswer, 153},
     "The stage that gave the answer; where it is `reference`, nothing else differs from `contact`."},
    {{{"paper_min_l"},
      kReal,
      {[](const AnswerRow& row, size_t) { return row.isSampled ? row.result.paperMinL : kNull; },
       set<&Result::paperMinL>},
      {When::sampled, When::never, When::sampled},
      64},
     "In mode `sampled`: the paper's literal min(L); may be negative, too early or too late."},
    {{{"resolution"}, kCount, kMember<&Result::resolution>, {When::never, When::never, When::sampled}, kNowhere},
     "In Python only, in mode `sampled`: pixels along the picture's longer side; 0 if none was drawn."},
};

template <class Number>
void put(char* to, double value) {
  if (std::isnan(value) && !std::is_floating_point_v<Number>) value = -1;
  const auto number = static_cast<Number>(value);
  std::memcpy(to, &number, sizeof number);
}

template <class Number>
double got(const char* from) {
  Number number;
  std::memcpy(&number, from, sizeof number);
  return number == static_cast<Number>(-1) && !std::is_floating_point_v<Number> ? kNull : static_cast<double>(number);
}

constexpr size_t sizeOf(const AnswerField& field) {
  return static_cast<size_t>(field.type[2] - '0');
}

/// Calls `work` with a number of the member's type.
template <class Work>
constexpr auto inType(const AnswerField& field, const Work& work) {
  if (field.isReal()) return work(double{});
  if (sizeOf(field) == 1) return work(int8_t{});
  return sizeOf(field) == 4 ? work(uint32_t{}) : work(int64_t{});
}

/// A member of a row, compiled for each, since arrays have millions of rows.
template <size_t index>
void putMember(const AnswerRow& row, bool keepsInfinities, char* to) {
  static constexpr const AnswerField& kField = kFields[index];
  for (size_t part = 0; part < kField.width; ++part) {
    double value = kField.value(row, part);
    if (!keepsInfinities && std::isinf(value)) value = kNull;
    inType(kField, [&]<class Number>(Number) { put<Number>(to + sizeof(Number) * part, value); });
  }
}

constexpr auto kPutMembers = []<size_t... index>(std::index_sequence<index...>) {
  return std::array{&putMember<index>...};
}
(std::make_index_sequence<std::size(kFields)>());

}  // namespace

AnswerRow::AnswerRow(const Query& query_, const Result& answer, AnswerMode mode, std::optional<double> speed_,
                     uint64_t index_, std::optional<LinksMet> links_)
    : query(query_),
      result(answer),
      links(links_),
      isStep(links || takesStep(query)),
      fractionLo(isStep ? answer.lo : kNull),
      fractionHi(isStep ? answer.hi : kNull),
      isSampled(mode == AnswerMode::sampled),
      speed(speed_),
      index(index_) {
  toDistances(query, result);
}

bool AnswerType::isTruth() const {
  return words.data() == kTruths;
}

std::span<const AnswerField> answerFields() {
  return kFields;
}

const AnswerField* findAnswerField(std::string_view name) {
  const auto* const found = std::ranges::find(kFields, name, &AnswerField::name);
  return found == std::end(kFields) ? nullptr : found;
}

bool has(const AnswerRow& row, When when) {
  switch (when) {
    case When::never:
      return false;
    case When::always:
      return true;
    case When::step:
      return row.isStep;
    case When::near:
      return row.query.clearance > 0;
    case When::timed:
      return row.speed.has_value();
    case When::sampled:
      return row.isSampled;
    case When::chain:
      return row.links.has_value();
  }
  return false;
}

double codeOf(const AnswerField& field, std::string_view word) {
  const auto found = std::ranges::find(field.words, word);
  return found == field.words.end() ? kNull : double(found - field.words.begin());
}

std::string wordsOf(const AnswerField& field) {
  std::string text;
  for (size_t i = 0; i < field.words.size(); ++i) {
    text.append(i == 0 ? "" : i + 1 < field.words.size() ? ", " : " or ").append(field.words[i]);
  }
  return text;
}

void AnswerLayout::write(const AnswerRow& row, char* record) const {
  static_assert(std::endian::native == std::endian::little);
  for (const auto& [field, place] : members) {
    kPutMembers[static_cast<size_t>(field - kFields)](row, keepsInfinities, record + place);
  }
}

Result AnswerLayout::read(const char* record) const {
  const auto numberOf = [&](const Member& member, size_t part) {
    return inType(*member.field,
                  [&]<class Number>(Number) { return got<Number>(record + member.place + sizeof(Number) * part); });
  };
  const auto status = std::ranges::find(members, findAnswerField("status"), &Member::field);
  Result result(static_cast<Status>(static_cast<uint32_t>(numberOf(*status, 0))));
  for (const Member& member : members) {
    for (size_t part = 0; part < member.field->width && member.field->set; ++part) {
      member.field->set(result, numberOf(member, part), part);
    }
  }
  return result;
}

const AnswerLayout& fileLayout() {
  static const AnswerLayout layout = [] {
    AnswerLayout made{.size = 160};
    for (const AnswerField& field : kFields) {
      if (field.place < made.size) made.members.push_back({&field, field.place});
    }
    std::ranges::sort(made.members, {}, &AnswerLayout::Member::place);
    return made;
  }();
  return layout;
}

const AnswerLayout& castsLayout(bool sampled) {
  // Large numbers first, so that each is aligned.
  const auto make = [](bool isSampled) {
    AnswerLayout made{.keepsInfinities = true};
    for (const AnswerField& field : kFields) {
      if (field.casts == When::always || (isSampled && field.casts == When::sampled))
        made.members.push_back({&field, 0});
    }
    std::ranges::stable_sort(made.members, std::greater(),
                             [](const AnswerLayout::Member& m) { return sizeOf(*m.field); });
    for (AnswerLayout::Member& member : made.members) {
      member.place = made.size;
      made.size += sizeOf(*member.field) * member.field->width;
    }
    made.size = (made.size + 7) / 8 * 8;
    return made;
  };
  static const AnswerLayout layouts[] = {make(false), make(true)};
  return layouts[sampled];
}

const char* nameOf(Status status) {
  return kStatuses[static_cast<size_t>(status)];
}

Status statusFrom(std::string_view name) {
  const AnswerField& field = *findAnswerField("status");
  const double code = codeOf(field, name);
  if (!std::isnan(code)) return static_cast<Status>(static_cast<uint32_t>(code));
  throw std::invalid_argument("expected " + wordsOf(field) + ", got \"" + std::string(name) + "\"");
}

const char* nameOf(Tier tier) {
  return kTiers[static_cast<size_t>(tier)];
}

const char* nameOf(Feature feature) {
  return kFeatures[static_cast<size_t>(feature)];
}

std::string answerFieldTable() {
  std::string text = "| member | number | meaning |\n|---|---|---|\n";
  for (const AnswerField& field : kFields) {
    std::string number = (field.width > 1 ? std::to_string(field.width) + " " : "") + (field.type + 1);
    for (size_t i = 0; i < field.words.size(); ++i) {
      number += (i == 0 ? ": " : ", ") + std::to_string(i) + " `" + field.words[i] + "`";
    }
    text += "| `" + std::string(field.name) + "` | " + number + " | " + field.about + " |\n";
  }
  return text;
}

}  // namespace radar::tools
