#include "task_table.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

std::vector<TaskRow> read_task_table(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  std::vector<TaskRow> rows;
  std::string line;
  std::getline(in, line);  // the names of the columns
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    std::string kind;
    TaskRow row;
    fields >> row.parent >> row.priority >> kind >> row.seconds >> row.silence >> row.bytes_in >> row.bytes_out;
    const int own = static_cast<int>(rows.size());
    if (!fields || row.parent >= own) throw std::runtime_error("not a line of a task table: " + line);
    if (row.parent >= 0) rows[static_cast<std::size_t>(row.parent)].children.push_back(own);
    rows.push_back(row);
  }
  return rows;
}

double total_seconds(const std::vector<TaskRow>& rows) {
  double sum = 0.0;
  for (const TaskRow& row : rows) sum += row.seconds;
  return sum;
}

double chain_seconds(const std::vector<TaskRow>& rows) {
  std::vector<double> end;  // of each row, if all workers one could wish for are there
  for (const TaskRow& row : rows)
    end.push_back(row.seconds + (row.parent >= 0 ? end[static_cast<std::size_t>(row.parent)] : 0.0));
  return end.empty() ? 0.0 : *std::max_element(end.begin(), end.end());
}
