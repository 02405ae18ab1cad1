#include "cyber_radar/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>

#include "batch/query_file.h"
#include "import/mesh_import.h"
#include "radar/displacement.h"
#include "radar/shapes.h"
#include "workloads/query_fields.h"

namespace radar::tools {

namespace {

constexpr double kFarthestTurn = 0x1p800;

void requireFinite(const char* option, const std::vector<double>& values) {
  for (double value : values) {
    if (!std::isfinite(value)) throw InputError(option, "", "expected finite numbers, got " + inShortest(value));
  }
}

void requireScale(const char* option, std::optional<double> scale) {
  if (!scale || (*scale > 0 && std::isfinite(*scale))) return;
  throw InputError(option, "", "expected a finite number above 0, got " + inShortest(*scale));
}

/// The sensor's pose: turned about an axis by an angle in degrees, then moved.
Transform poseFrom(const std::vector<double>& at, const std::vector<double>& rotate) {
  Transform pose;
  if (!rotate.empty()) {
    const double length = std::hypot(rotate[0], rotate[1], rotate[2]);
    if (length == 0) throw InputError("--rotate", "", "expected an axis that is not zero");
    const double x = rotate[0] / length, y = rotate[1] / length, z = rotate[2] / length;
    const double angle = rotate[3] * (std::acos(-1.0) / 180), c = std::cos(angle), s = std::sin(angle), u = 1 - c;
    pose.m = {c + x * x * u,     x * y * u - z * s, x * z * u + y * s, 0,  //
              y * x * u + z * s, c + y * y * u,     y * z * u - x * s, 0,  //
              z * x * u - y * s, z * y * u + x * s, c + z * z * u,     0};
  }
  for (size_t k = 0; k < at.size(); ++k) pose.m[4 * k + 3] = at[k];
  return pose;
}

uint32_t resolutionFrom(const std::string& text) {
  if (text == "auto") return 0;
  uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1 || value > kMaxResolution) {
    throw InputError(
        "--resolution", "",
        "expected auto or a whole number from 1 to " + std::to_string(kMaxResolution) + ", got \"" + text + "\"");
  }
  return value;
}

/// NaN for what is no number.
double numberFrom(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : std::nan("");
}

/// The nodes of a file; of FILE#NODE that node, in its own frame and without a name.
Assembly nodesOf(const std::string& name, std::vector<std::string>& warnings, double scale) {
  Assembly nodes;
  if (splitMeshName(name).node) {
    nodes.meshes.push_back(readMesh(name, warnings, scale));
    nodes.parts.emplace_back();
  } else {
    nodes = readAssembly(name, warnings, scale);
    if (nodes.parts.size() == 1) nodes.meshes[0].name = std::filesystem::path(name).filename().string();
  }
  return nodes;
}

/// "ball:2" is a ball of that radius, else a mesh file is meant.
FileMesh sensorFrom(const std::string& name, std::vector<std::string>& warnings, double scale) {
  constexpr std::string_view kBall = "ball:";
  if (!name.starts_with(kBall)) return readMesh(name, warnings, scale);
  double radius = 0;
  const char *const begin = name.data() + kBall.size(), *const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(begin, end, radius);
  if (error != std::errc() || rest != end || !(radius >= 0 && radius <= 0x1p1000)) {
    throw InputError("SENSOR", name, "expected a radius from 0 to 2^1000 behind \"ball:\"");
  }
  const RoundShape shape = ball(radius);
  return {{name, shape.positions, shape.indices, shape.radius}, {}};
}

}  // namespace

std::vector<NamedOption> EngineOptions::addTo(Command& command) {
  const Option modeOption =
      command
          .option("--mode", &mode,
                  "How to answer: contact, exact, on a Vulkan device or on the CPU (see --cpu-batch); sampled, the "
                  "paper's method on the device, an upper bound of the distance; reference, exact on the CPU, without "
                  "a device")
          .value("sampled|contact|reference");
  std::vector<NamedOption> all = addResolutionTo(command);
  all.push_back({"--mode", modeOption});
  all.push_back({"--cpu-batch", command
                                    .option("--cpu-batch", &cpuBatch,
                                            "In mode contact, batches of fewer queries are answered on the CPU, with "
                                            "the same answers; 0: none; else learnt from the batches")
                                    .value("N")});
  all.push_back({"--threads",
                 command.option("--threads", &threads, "Threads of the exact search on the CPU; 0: one for each core")
                     .value("N")
                     .within(0, 4096)});
  return all;
}

std::vector<NamedOption> EngineOptions::addResolutionTo(Command& command) {
  const Option pixels =
      command
          .option("--resolution", &resolution,
                  "Pixels of the longer side of a sensor's window in mode sampled; pixels are square; auto chooses "
                  "from the size of the sensor and of its triangles")
          .value("N|auto");
  const Option number =
      command
          .option("--device", &device,
                  std::string("Number of the device, as cyber-radar devices lists them; else the best one") +
                      (severalDevices ? ". Several share the work: 0,1, or all" : ""))
          .value(severalDevices ? "I,...|all" : "I");
  return {{"--resolution", pixels}, {"--device", number}};
}

void addDevicesTo(Command& command, std::string& devices) {
  command.option("--device", &devices, "Numbers of the devices, as cyber-radar devices lists them: 0,1, or all")
      .value("I,...|all");
}

AnsweringOptions EngineOptions::checked() const {
  AnsweringOptions options;
  try {
    options.mode = modeFrom(mode);
  } catch (const std::invalid_argument& error) {
    throw InputError("--mode", "", error.what());
  }
  options.resolution = resolutionFrom(resolution);
  options.cpuBatch = cpuBatch.value_or(kNone);
  options.threads = threads;
  options.onCompiling = [](const std::string& shader, uint32_t seconds) {
    if (seconds == 2 || seconds % 10 == 0) {
      std::cerr << "cyber-radar: the driver compiles " + shader + ", for " + std::to_string(seconds) + " s so far\n";
    }
    return true;
  };
  options.onLost = [](const std::string& how) { printWarnings({"the CPU alone answers mode contact: " + how}); };
  if (!device) return options;
  const std::vector<uint32_t> devices = devicesFrom(*device);
  if (devices.size() == 1) {
    options.device = devices[0];
  } else if (severalDevices) {
    options.pool = devices;
  } else {
    throw InputError("--device", "", "expected the number of one device, got \"" + *device + "\"");
  }
  return options;
}

std::vector<uint32_t> devicesFrom(const std::string& text) {
  std::vector<uint32_t> devices;
  if (text == "all") return devices;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    uint32_t value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || (next != end && *next != ',')) {
      throw InputError("--device", "", "expected all or numbers with commas between, got \"" + text + "\"");
    }
    devices.push_back(value);
    if (next == end) return devices;
    at = next + 1;
  }
}

std::vector<NamedOption> SweepOptions::addMotionTo(Command& command) {
  std::vector<NamedOption> added;
  const auto add = [&](const char* name, OptionTarget target, const char* about) {
    added.push_back({name, command.option(name, std::move(target), about)});
    return added.back().option;
  };
  add("--direction", &direction, "Where the sensor moves; the length does not matter").count(3).value("X Y Z");
  add("--distance", &distance, "How far, in the unit of the scaled meshes").value("D");
  add("--at", &at, "Puts the sensor's origin here").count(3).value("X Y Z");
  add("--rotate", &rotate, "Turns the sensor first: an axis and degrees").count(4).value("X Y Z ANGLE");
  add("--scale", &scale, "Multiplies the numbers of both files: 0.001 makes metres of millimetres").value("S");
  add("--sensor-scale", &sensorScale, "The same for the sensor's file, instead of --scale").value("S");
  return added;
}

void SweepOptions::addFieldsTo(Command& command) {
  for (const QueryField& field : queryFields()) {
    if (!field.option) continue;
    std::string name = std::string("--") + field.name;
    std::ranges::replace(name, '_', '-');
    const std::function<void(double)> set = [&, name](double value) {
      if (std::isnan(value) || !setValue(fields, field, value)) {
        throw InputError(name, "", "expected " + expectedFor(field) + ", got " + inShortest(value));
      }
    };
    if (field.kind() == 'b') {
      command.option(
          name, [set] { set(1); }, field.about);
    } else if (field.word) {
      const std::function<void(const std::string&)> read = [set, word = field.word](const std::string& text) {
        set(text == word ? HUGE_VAL : numberFrom(text));
      };
      command.option(name, read, field.about).value("N|" + std::string(field.word));
    } else {
      command.option(name, set, field.about);
    }
  }
  command.option("--exclude", &exclude, "Nodes of the scene that take no part, by number or name")
      .list()
      .value("NODE,...");
}

void SweepOptions::addTurnTo(Command& command) {
  command
      .option("--turn", &turn,
              "Turns the sensor during the motion, or without one, by the right-hand rule: an axis and radians")
      .count(4)
      .value("X Y Z ANGLE");
  command
      .option("--centre", &centre,
              "Where the axis of --turn is at the start; it moves with the sensor. Else where --at puts the origin")
      .count(3)
      .value("X Y Z");
}

void SweepOptions::setTurn(QuerySpec& query) const {
  requireFinite("--turn", turn);
  requireFinite("--centre", centre);
  Turn& its = query.turn.emplace(Turn{{turn[0], turn[1], turn[2]}, turn[3], {}});
  if (its.axis == std::array<double, 3>{}) throw InputError("--turn", "", "expected an axis that is not zero");
  if (std::abs(its.angle) > 0x1p16) {
    throw InputError("--turn", "", "expected an angle of at most 2^16, got " + inShortest(its.angle));
  }
  const std::vector<double>& from = centre.empty() ? at : centre;
  std::ranges::copy(from, its.centre.begin());
  for (const double value : from) {
    if (std::abs(value) > kFarthestTurn) {
      throw InputError(centre.empty() ? "--at" : "--centre", "", "expected at most 2^800, got " + inShortest(value));
    }
  }
  if (query.speed) throw InputError("--speed", "", "expected none beside --turn");
  if (query.ignoreLeaving && query.clearance > 0) {
    throw InputError("--ignore-leaving", "", "expected none beside --turn and a clearance");
  }
  if (query.distance == 0) {
    query.direction = {};
    return;
  }
  if (query.distance > kFarthestTurn) throw InputError("--distance", "", "expected at most 2^800 beside --turn");
  QuerySpec straight = query;
  straight.turn.reset();
  query.motion = displacementOf(straight);
  query.direction = {};
  query.distance = 0;
}

void SweepOptions::setCourse(QuerySpec& query) const {
  if (turn.empty() && !centre.empty())
    throw InputError("--centre", "", "expected it with --turn, whose axis it places");
  if (!turn.empty() && direction.empty() && !distance) return setTurn(query);
  if (direction.empty()) throw InputError("--direction", "", "expected three numbers, got none");
  if (!distance) throw InputError("--distance", "", "expected a number, got none");
  requireFinite("--direction", direction);
  requireFinite("--distance", {*distance});
  std::copy(direction.begin(), direction.end(), query.direction.begin());
  if (query.direction == std::array<double, 3>{}) {
    throw InputError("--direction", "", "expected a vector that is not zero");
  }
  query.distance = *distance;
  if (query.distance < 0) throw InputError("--distance", "", "expected a number of 0 or more");
  if (!turn.empty()) setTurn(query);
}

Workload SweepOptions::load() const {
  requireFinite("--at", at);
  requireFinite("--rotate", rotate);
  requireScale("--scale", scale);
  requireScale("--sensor-scale", sensorScale);
  QuerySpec query = fields;
  query.id = "sweep";
  setCourse(query);
  std::vector<std::string> warnings;
  Workload workload;
  const Assembly nodes = nodesOf(scene, warnings, scale.value_or(1));
  const FileMesh moving = sensorFrom(sensor, warnings, sensorScale ? *sensorScale : scale.value_or(1));
  workload.meshes.assign(nodes.meshes.begin(), nodes.meshes.end());
  workload.meshes.push_back(moving);
  SceneSpec& objects = workload.scenes.emplace_back();
  objects.id = "scene";
  for (const Assembly::Part& part : nodes.parts) {
    objects.instances.push_back({part.mesh, aboutBase(part.fileFromNode, nodes.meshes[part.mesh].base)});
    if (nodes.parts.size() > 1) objects.names.push_back(part.name);
  }
  for (const std::string& node : exclude) query.exclude.push_back(nodes.numberOf(scene, node));
  query.setSensor({static_cast<uint32_t>(nodes.meshes.size()), aboutBase(poseFrom(at, rotate), moving.base)});
  query.clearance = withRadius(query.clearance, moving.radius);
  workload.queries.push_back(query);
  printWarnings(warnings);
  return workload;
}

void printWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::cerr << "cyber-radar: warning: " << warning << "\n";
}

}  // namespace radar::tools
