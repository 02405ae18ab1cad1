#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "batch/answer_rows.h"
#include "batch/atomic_file.h"
#include "batch/query_file.h"
#include "cyber_radar/answer_page.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/words.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr uint32_t kTeapots = 12;

struct Row {
  const QuerySpec& query;
  const Answer& sampled;
  const Answer& exact;
};

std::string number(double value, const char* format) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string tableOf(const std::vector<Row>& rows) {
  std::string text =
      "                    the paper's method (sampled)   exact (reference)\n"
      "teapot              status            t  object    status            t  object    late by\n";
  const auto object = [](const Result& result) { return result.object == kNone ? "-" : std::to_string(result.object); };
  for (const auto& [query, sampled, exact] : rows) {
    const Result &a = sampled.result, &b = exact.result;
    char line[160];
    std::snprintf(line, sizeof line, "%-20s%-10s%9s%8s    %-10s%9s%8s%11s\n", query.id.c_str(), nameOf(a.status),
                  number(a.t, "%.4f").c_str(), object(a).c_str(), nameOf(b.status), number(b.t, "%.4f").c_str(),
                  object(b).c_str(), number(a.t - b.t, "%.1e").c_str());
    text += line;
  }
  return text;
}

std::vector<Answer> answersIn(const Workload& workload, AnswerMode mode, AnsweringOptions engine) {
  engine.mode = mode;
  Answering answering(workload, modesOf(workload), engine);
  return answersTo(workload, answering, nameOf(mode));
}

/// The first that hits something: what the page opens on.
std::optional<uint32_t> firstHit(std::span<const Answer> answers) {
  const auto isHit = [](const Answer& answer) { return answer.result.status == Status::hit; };
  const auto found = std::ranges::find_if(answers, isHit);
  if (found == answers.end()) return std::nullopt;
  return static_cast<uint32_t>(found - answers.begin());
}

int demonstrate(const std::string& out, const AnsweringOptions& engine) {
  Figure7 settings;
  settings.teapots = kTeapots;
  settings.steps = 1;
  const Workload workload = makeWorkload(settings);
  const std::filesystem::path folder = out;
  const std::filesystem::path file = writeQueryFile(workload, folder);
  std::cout << kTeapots << " teapots of " << workload.meshes[1].triangleCount() << " triangles fly among "
            << settings.boxes << " boxes.\nWhat does each hit within " << inDigits(workload.queries[0].distance)
            << " units, and after how far?\n\n";

  const Device device = Device::open({.index = engine.device});
  const std::vector<Answer> sampled = answersIn(workload, AnswerMode::sampled, engine);
  const std::vector<Answer> exact = answersIn(workload, AnswerMode::reference, engine);
  std::vector<Row> rows;
  for (size_t i = 0; i < sampled.size(); ++i) rows.push_back({workload.queries[i], sampled[i], exact[i]});
  const std::string table = tableOf(rows);
  std::cout << table << "\nobjects below " << settings.boxes << " are boxes, the others teapots; sampled on "
            << device.name() << " (" << device.driver() << ")\n";
  writeAtomically(folder / "table.txt", table);
  AnswerRows lines(workload, AnswerFormat::lines);
  writeAtomically(folder / "answers-sampled.jsonl", lines.text(0, workload.queries, sampled));
  writeAtomically(folder / "answers-reference.jsonl", lines.text(0, workload.queries, exact));

  const std::string title = std::to_string(kTeapots) + " teapots among " + std::to_string(settings.boxes) + " boxes";
  writePage(folder / "demo.html", title, workload, exact,
            {.device = &device, .sampled = sampled, .tour = firstHit(sampled)});
  std::cout << "\nIn " << std::filesystem::absolute(folder).string()
            << ":\n  page       demo.html, for any browser: each teapot, its contact, and R, M and L\n"
               "  answers    table.txt, answers-sampled.jsonl, answers-reference.jsonl\n  questions  "
            << file.filename().string() << "; try: cyber-radar query " << file.string() << "\n";
  return someInvalid(sampled) ? kStatusSomeInvalid : 0;
}

}  // namespace

void addDemoCommand(Program& program) {
  Command command = program.add(
      "demo", "The paper's teapots among boxes: a table of answers, and a page that shows each flight, R, M and L");
  auto out = std::make_shared<std::string>("cyber-radar-demo");
  auto engine = std::make_shared<EngineOptions>();
  command.option("--out", out.get(), "Folder for everything").value("DIR");
  engine->addResolutionTo(command);
  command.run([out, engine] { return demonstrate(*out, engine->checked()); });
}

}  // namespace radar::tools
