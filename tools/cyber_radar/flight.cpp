#include "cyber_radar/flight.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cyber_radar/film.h"
#include "cyber_radar/scene_picture.h"
#include "radar/cpu_sweeper.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

// Before a contact and after it: far more than rounding, far less than can be seen.
constexpr double kMoment = 1e-9;
constexpr uint64_t kSeed = 7;
constexpr uint32_t kBoxes = 110, kTeapots = 14;
constexpr double kSide = 26, kTeapotSize = 3;
constexpr uint32_t kPictures = 49, kResolution = 480;
constexpr double kMargin = 10, kCaption = 40;
constexpr uint16_t kMilliseconds = 80, kLastMilliseconds = 2500;
constexpr Colour kPath{0.75, 0.15, 0.10};

/// A scene with what flies in it.
class Prediction {
 public:
  Prediction(const Workload& workload, const std::vector<Flyer>& flyers) : flyers_(flyers), cpu_(scene_) {
    replaceBy(workload, 0, scene_);
  }

  /// What each of these touches first while all move, at which fraction of the rest of the step.
  std::vector<Result> predict(double time, const std::vector<size_t>& which) {
    for (const Flyer& flyer : flyers_) {
      scene_.setTransform(flyer.object, flyer.poseAt(time));
      scene_.setMotion(flyer.object, flyer.stops > time ? (1 - time) * flyer.way : Vec3{});
    }
    std::vector<Query> queries;
    for (const size_t i : which) {
      queries.push_back(queryOf(flyers_[i], time));
      queries.back().motion = (1 - time) * flyers_[i].way;
    }
    return cpu_.run(queries).results;
  }

  /// Whether its surface meets nothing at that time.
  bool isFree(const Flyer& flyer, double time) {
    for (const Flyer& each : flyers_) {
      scene_.setMotion(each.object, {});
      scene_.setTransform(each.object, each.poseAt(time));
    }
    Query query = queryOf(flyer, time);
    query.direction = {0, 0, 1};
    return cpu_.run({&query, 1}).results[0].status == Status::clear;
  }

 private:
  static Query queryOf(const Flyer& flyer, double time) {
    Query query;
    query.mesh = flyer.mesh;
    query.worldFromMesh = flyer.poseAt(time);
    query.exclude = {flyer.object};
    return query;
  }

  const std::vector<Flyer>& flyers_;
  Scene scene_;
  CpuSweeper cpu_;
};

/// Boxes and, after them, teapots at random places in a cube, apart from each other.
Workload sky() {
  Workload workload;
  workload.meshes = {makeBox(kFull), makeTeapot()};
  workload.scenes.emplace_back();
  const MeshExtent teapot = extentOf(workload.meshes[1]);
  const double size = kTeapotSize / teapot.longest;
  Random random(kSeed);
  struct Ball {
    Vec3 middle;
    double radius;
  };
  std::vector<Ball> taken;
  const auto freePlace = [&](double radius) {
    while (true) {
      const Ball ball{random.inCube(0.5 * kSide - radius), radius};
      const auto isApart = [&](const Ball& other) {
        return lengthOf(other.middle - ball.middle) > other.radius + ball.radius;
      };
      if (!std::ranges::all_of(taken, isApart)) continue;
      taken.push_back(ball);
      return ball.middle;
    }
  };
  for (uint32_t i = 0; i < kBoxes + kTeapots; ++i) {
    const bool isBox = i < kBoxes;
    const double scale = isBox ? random.uniform(0.8, 2.5) : size;
    const Vec3 middle = freePlace(isBox ? scale : size * teapot.radius);
    const Rotation rotation = random.rotation();
    const Vec3 offset = isBox ? Vec3{} : turned(rotation, size * teapot.middle);
    workload.scenes[0].instances.push_back(
        {isBox ? 0u : 1u, makePose(rotation, {scale, scale, scale}, middle - offset)});
  }
  return workload;
}

/// In the world, at the start.
Vec3 middleOf(const Flyer& flyer, const Workload& workload) {
  const Vec3 place{flyer.start.m[3], flyer.start.m[7], flyer.start.m[11]};
  return turned(linearPart(flyer.start), extentOf(workload.meshes[flyer.mesh]).middle) + place;
}

/// Each teapot flies to where the nearest other one is at the start.
std::vector<Flyer> flyersOf(const Workload& workload) {
  std::vector<Flyer> flyers;
  std::vector<Vec3> middles;
  const std::vector<Instance>& all = workload.scenes[0].instances;
  for (uint32_t i = 0; i < all.size(); ++i) {
    if (all[i].mesh == 0) continue;
    flyers.push_back({.object = i, .mesh = all[i].mesh, .start = all[i].worldFromMesh});
    middles.push_back(middleOf(flyers.back(), workload));
  }
  for (size_t i = 0; i < flyers.size(); ++i) {
    double least = INFINITY;
    for (size_t k = 0; k < flyers.size(); ++k) {
      const Vec3 way = middles[k] - middles[i];
      if (k == i || !(lengthOf(way) < least)) continue;
      least = lengthOf(way);
      flyers[i].way = way;
    }
  }
  return flyers;
}

/// The surfaces of both views, which have the same pixels.
Scopes together(const Scopes& a, const Scopes& b) {
  Scopes all = a;
  for (size_t i = 0; i < all.R.size(); ++i) {
    if (std::isnan(all.R[i]) || b.R[i] < all.R[i]) all.R[i] = b.R[i];
  }
  return all;
}

/// Draws where a flyer comes from and where it is expected to stop.
void drawPath(const Canvas& canvas, const Scopes& view, const Flyer& flyer, const Vec3& from, double time, double stop,
              const Result& contact) {
  cairo_t* cairo = canvas.get();
  const auto goTo = [&](double when, auto draw) {
    const auto [x, y] = pixelOf(view, from + when * flyer.way, kMargin);
    draw(cairo, x, y);
  };
  const bool touches = std::isfinite(stop), isOver = touches && stop <= time;
  canvas.colour(kPath);
  cairo_set_line_width(cairo, 1.5);
  goTo(0, cairo_move_to);
  goTo(isOver ? stop : time, cairo_line_to);
  cairo_stroke(cairo);
  const double dashes[] = {3, 3};
  cairo_set_dash(cairo, dashes, 2, 0);
  goTo(time, cairo_move_to);
  if (!isOver) goTo(touches ? stop : 1, cairo_line_to);
  cairo_stroke(cairo);
  cairo_set_dash(cairo, nullptr, 0, 0);
  if (!touches) return;
  const auto [x, y] = pixelOf(view, contact.point, kMargin);
  cairo_arc(cairo, x, y, 4.5, 0, 2 * std::acos(-1.0));
  if (isOver) {
    cairo_fill(cairo);
  } else {
    cairo_stroke(cairo);
  }
}

std::string inColumn(const char* format, double value) {
  char text[32] = "-";
  if (std::isfinite(value)) std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string objectOf(const Result& contact) {
  return contact.object == kNone ? "-" : std::to_string(contact.object);
}

}  // namespace

Transform Flyer::poseAt(double time) const {
  Transform pose = start;
  for (size_t k = 0; k < 3; ++k) pose.m[4 * k + 3] += std::min(time, stops) * way[k];
  return pose;
}

Flight fly() {
  Flight flight;
  flight.workload = sky();
  flight.flyers = flyersOf(flight.workload);
  std::vector<Flyer>& flyers = flight.flyers;
  for (Flyer& flyer : flyers) flyer.stops = 1 + kMoment;
  Prediction prediction(flight.workload, flyers);
  Forecast forecast{0, std::vector<double>(flyers.size(), INFINITY), std::vector<Result>(flyers.size())};
  std::vector<size_t> flying;
  for (size_t i = 0; i < flyers.size(); ++i) flying.push_back(i);
  while (!flying.empty()) {
    const double now = forecast.from;
    const std::vector<Result> found = prediction.predict(now, flying);
    double next = INFINITY;
    for (size_t k = 0; k < flying.size(); ++k) {
      forecast.contacts[flying[k]] = found[k];
      forecast.stops[flying[k]] = now + found[k].fraction * (1 - now);
      next = std::min(next, forecast.stops[flying[k]]);
    }
    flight.forecasts.push_back(forecast);
    if (std::isinf(next)) break;
    const auto stopsNow = [&](size_t i) { return forecast.stops[i] <= next + kMoment; };
    for (const size_t i : flying) {
      if (!stopsNow(i)) continue;
      flyers[i].contact = forecast.contacts[i];
      flyers[i].isVerified =
          prediction.isFree(flyers[i], next - kMoment) && !prediction.isFree(flyers[i], next + kMoment);
    }
    for (const size_t i : flying) {
      if (stopsNow(i)) flyers[i].stops = forecast.stops[i];
    }
    std::erase_if(flying, stopsNow);
    forecast.from = next;
  }
  return flight;
}

std::string tableOf(const Flight& flight) {
  std::string text =
      "                    predicted at first   happened\n"
      "teapot                  time  object         time  object  apart before, not after\n";
  const Forecast& first = flight.forecasts.front();
  for (size_t i = 0; i < flight.flyers.size(); ++i) {
    const Flyer& flyer = flight.flyers[i];
    const bool touches = flyer.contact.status != Status::invalid;
    char line[160];
    std::snprintf(line, sizeof line, "%-20s%8s%8s     %8s%8s  %s\n", ("teapot/" + std::to_string(flyer.object)).c_str(),
                  inColumn("%.4f", first.stops[i]).c_str(), objectOf(first.contacts[i]).c_str(),
                  inColumn("%.4f", touches ? flyer.stops : INFINITY).c_str(), objectOf(flyer.contact).c_str(),
                  !touches           ? "-"
                  : flyer.isVerified ? "yes"
                                     : "no");
    text += line;
  }
  return text;
}

void drawFlight(const Flight& flight, const Device& device, const std::filesystem::path& frames,
                const std::filesystem::path& film) {
  // The scenes 1 and 2 have what rests and what flies.
  Workload stage = flight.workload;
  const auto disc = static_cast<uint32_t>(stage.meshes.size());
  stage.meshes.push_back(viewingDisc(kSide));
  const std::vector<Instance>& all = stage.scenes[0].instances;
  const auto firstFlyer = all.begin() + flight.flyers.front().object;
  const SceneSpec resting{"what rests", {}, {all.begin(), firstFlyer}},
      moving{"what flies", {}, {firstFlyer, all.end()}};
  stage.scenes.push_back(resting);
  stage.scenes.push_back(moving);
  Scene still, movers;
  replaceBy(stage, 1, still);
  replaceBy(stage, 2, movers);
  const Query view = viewOf(disc, kSide, kResolution);
  const Scopes boxes = Sweeper(device, still).scopes(view);
  Sweeper sweeper(device, movers);
  std::filesystem::create_directories(frames);
  Film reel;
  auto forecast = flight.forecasts.begin();
  for (uint32_t picture = 0; picture < kPictures; ++picture) {
    const double time = picture / (kPictures - 1.0);
    while (std::next(forecast) != flight.forecasts.end() && std::next(forecast)->from <= time) ++forecast;
    for (ObjectId id = 0; id < flight.flyers.size(); ++id) movers.setTransform(id, flight.flyers[id].poseAt(time));
    const Scopes flyers = sweeper.scopes(view);
    const Scopes both = together(boxes, flyers);
    const Canvas canvas(2 * kMargin + both.width, 2 * kMargin + both.height + kCaption);
    drawSurfaces(canvas, kMargin, kSide, both, flyers);
    for (size_t i = 0; i < flight.flyers.size(); ++i) {
      const Flyer& flyer = flight.flyers[i];
      drawPath(canvas, both, flyer, middleOf(flyer, flight.workload), time, forecast->stops[i], forecast->contacts[i]);
    }
    char caption[80];
    std::snprintf(caption, sizeof caption, "Time %.2f of the step. What touches something stays there.", time);
    canvas.text(kMargin, kMargin + both.height + 18, 13, caption);
    canvas.text(kMargin, kMargin + both.height + 36, 13,
                "Ring: contact predicted while all move. Dot: it has happened.");
    char name[16];
    std::snprintf(name, sizeof name, "%02u.png", picture);
    canvas.write(frames / name);
    reel.add(canvas);
  }
  reel.write(film, kMilliseconds, kLastMilliseconds);
}

}  // namespace radar::tools
