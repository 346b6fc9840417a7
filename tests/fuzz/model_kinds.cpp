#include "fuzz/kinds.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/document/document.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/text/system_of.hpp"

namespace orbweaver::fuzz {

namespace {

const std::vector<std::string> formula_words{"(",
                                             ")",
                                             "[",
                                             "]",
                                             "'",
                                             "''",
                                             "^",
                                             "**",
                                             "..",
                                             ",",
                                             "=",
                                             ":",
                                             "-",
                                             "*",
                                             "/",
                                             "x",
                                             "th[k]",
                                             "th[k+1]",
                                             "sum(j = 1..n, ",
                                             "sin(",
                                             "abs(",
                                             "t",
                                             "phase",
                                             "pi",
                                             "1e999",
                                             "1e-320",
                                             "0",
                                             "for i = 1..1000000:",
                                             "\n",
                                             "\n  ",
                                             "#",
                                             "\"",
                                             "{",
                                             "}",
                                             "| ",
                                             "> ",
                                             "~",
                                             "!!int",
                                             "&a",
                                             "*a",
                                             "<<",
                                             "dx/dt",
                                             "true",
                                             "n",
                                             "1..n",
                                             "((((((((((((((((((((",
                                             "\xff",
                                             "no"};
const std::vector<std::string> formula_numbers{"0", "1", "-1", "2", "0.5", "1e300", "x", "(x)", "y'", "links", "9999"};

const std::vector<std::string> name_words{"\x1b[31m", "\xff", "\xc2\x9b", "é", std::string(1, '\0'), "\t", "x", "<>"};

}  // namespace

Kind models() {
  std::vector<std::string> texts;
  for (const std::string& name : systems::system_names()) texts.push_back(systems::system_text(name));
  return {[texts](Mutator& mutator) {
            std::string text = texts[mutator.below(texts.size())];
            for (std::size_t n = 1 + mutator.below(4); n > 0; --n)
              text = mutator.below(2) == 0 ? mutator.edited(std::move(text), formula_numbers, formula_words)
                                           : mutator.changed(std::move(text), formula_words);
            return text;
          },
          [](const std::string& text) {
            const document::Source source("fuzz.yaml", {});
            const document::Field field(source, document::parse_document(text, "fuzz.yaml", true), "", 1);
            const systems::ModelText model = systems::read_model(field);
            std::vector<std::string> effects;
            for (const systems::EffectText& effect : model.effects) effects.push_back(effect.name);
            for (const std::vector<std::string>& on : {std::vector<std::string>(), effects}) {
              const systems::BuiltModel built = systems::build_model(model, {}, on);
              systems::Bound bound{{}, on, {}};
              for (const systems::Parameter& parameter : built.info.parameters)
                bound.parameters[parameter.name] = parameter.standard;
              for (const systems::Effect& effect : built.info.effects)
                for (const systems::Parameter& parameter : effect.parameters)
                  bound.parameters[parameter.name] = parameter.standard;
              const auto system = systems::system_of(built, bound);
              const std::vector<double> z(static_cast<std::size_t>(system->dimension()), 0.5);
              std::vector<double> f(z.size());
              system->field(1, z.data(), f.data());
            }
          }};
}

Kind descriptions() {
  return {[](Mutator& mutator) {
            std::string text = "my_system\nMy system\nwhat moves\nq\np\nk\n1/s\nstiffness";
            return mutator.below(3) == 0 ? text : mutator.changed(text, name_words);
          },
          [](const std::string& text) {
            std::vector<std::string> words{""};
            for (const char c : text)
              if (c == '\n')
                words.emplace_back();
              else
                words.back() += c;
            words.resize(8);
            systems::ModelInfo info;
            info.name = words[0];
            info.title = words[1];
            info.meaning = words[2];
            info.state_names = {words[3], words[4]};
            info.winding_names = {words[3], ""};
            info.parameters = {{words[5], 1.0, 0.0, 2.0, false, words[6], words[7]}};
            info.effects = {{words[5], words[2], info.parameters}};
            systems::require_description(info);
            for (const std::string& word : words)
              if (core::printable(word) != word) throw WrongReading{"a description that cannot be shown"};
          }};
}

}  // namespace orbweaver::fuzz
