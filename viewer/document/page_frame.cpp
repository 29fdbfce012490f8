#include "viewer/document/page_frame.h"

#include <fmt/format.h>

#include "viewer/document/document.h"
#include "viewer/export/page_data.h"

namespace lightwell {
namespace {

constexpr const char* page_head = R"(<!DOCTYPE html>
<html lang="{3}"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<meta name="generator" content="Lightwell"><title>{0}</title>
<style>
@page {{ size: A4; margin: 16mm 13mm 18mm; @bottom-right {{ content: counter(page) " / " counter(pages); font: 9px system-ui, sans-serif; color: #666; }}
  @bottom-left {{ content: "{1}"; font: 9px system-ui, sans-serif; color: #666; }} }}
body {{ font: 15px/1.45 system-ui, sans-serif; color: #1b1b1b; background: #fff; max-width: 190mm; margin: 2rem auto; padding: 0 1rem; }}
h1 {{ font-size: 1.7rem; margin: 0 0 .3rem; }} h2 {{ font-size: 1.2rem; margin-top: 2rem; border-bottom: 2px solid #1b1b1b; padding-bottom: .15rem; }} h3 {{ font-size: 1rem; margin: 1.2rem 0 .3rem; }}
p, figcaption {{ color: #444; max-width: 50rem; }}
table {{ border-collapse: collapse; font-variant-numeric: tabular-nums; margin: .6rem 0; }}
th, td {{ padding: .25rem .9rem .25rem 0; text-align: right; border-bottom: 1px solid #ddd; vertical-align: top; }}
th:first-child, td:first-child, .text {{ text-align: left; }} th {{ font-weight: 600; border-bottom-color: #888; }}
tr.total td {{ font-weight: 600; }} tr.total small {{ font-weight: 400; }} .kind td:first-child {{ padding-left: 1rem; color: #444; }}
small {{ color: #666; white-space: nowrap; }} figure {{ margin: 1rem 0 1.6rem; }} svg {{ max-width: 100%; height: auto; }} figure img {{ width: 100%; height: auto; display: block; }}
.heading {{ display: grid; grid-template-columns: max-content auto; gap: .1rem 1rem; margin: .8rem 0; }} .heading dt {{ color: #666; }} .heading dd {{ margin: 0; }}
.luminaire-card {{ display: flex; gap: 1.5rem; align-items: center; }}
{2}@media print {{ body {{ margin: 0; padding: 0; max-width: none; font-size: 11px; }} * {{ print-color-adjust: exact; -webkit-print-color-adjust: exact; }}
  h2, h3 {{ break-after: avoid; }} tr, tbody, figure, .luminaire-card {{ break-inside: avoid; }} .surface {{ break-before: page; }} }}
</style></head><body>
)";

constexpr const char* drawing_rules =
    R"(.value { font-size: 2.1px; text-anchor: middle; fill-opacity: .85; }
.label { font-size: 2.7px; font-weight: 600; text-anchor: middle; paint-order: stroke; stroke: #fff; stroke-width: .9px; stroke-linejoin: round; }
.axis { font-size: 2.8px; text-anchor: middle; fill: #333; } .axis.left { text-anchor: end; } .axis.right, .axis.scale { text-anchor: start; }
.number { font-size: 2.4px; font-weight: 600; text-anchor: middle; fill: #fff; }
.plan path, .polar path, .polar circle { fill: none; stroke-linejoin: round; } .wall { stroke: #000; stroke-width: .7; stroke-linecap: square; }
.pane { stroke: #1769c2; stroke-width: .9; } .edge { stroke: #000; stroke-opacity: .7; stroke-width: .22; }
.plan .luminaire { stroke: #d2380b; stroke-width: .35; fill: #fff; fill-opacity: .15; } .cross { stroke: #d2380b; stroke-width: .25; }
.iso-under { stroke: #fff; stroke-width: .8; stroke-opacity: .75; } .iso { stroke: #000; stroke-width: .3; }
.plan .eye { fill: #7a1fa2; stroke: #fff; stroke-width: .3; } .look { stroke: #7a1fa2; stroke-width: .6; }
.tick { stroke: #333; stroke-width: .2; } .bar { stroke: #000; stroke-width: .9; } .plan .north { fill: #000; }
.ring { stroke: #bbb; stroke-width: .15; } .curve { stroke: #d2380b; stroke-width: .45; } .across { stroke-dasharray: 1.4 .9; }
)";

// Text within quotes of a style sheet, without the characters that mean something there.
std::string for_style(std::string text) {
  for (char& c : text) {
    if (c == '"' || c == '\\' || c == '<' || c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

}  // namespace

std::string drawing_style(const std::string& family) {
  return "svg text { font-family: " + family + "; }\n" + drawing_rules;
}

std::string page_begin(const std::string& title, const char* language) {
  return fmt::format(fmt::runtime(page_head), marked(title), for_style(title),
                     drawing_style("system-ui, sans-serif"), language);
}

std::string list_section(const char* title, const std::vector<std::string>& sentences) {
  if (sentences.empty()) return {};
  std::string section = fmt::format("<h2>{}</h2>\n<ul>", title);
  for (const std::string& sentence : sentences) {
    section += "<li>" + html_text(sentence) + "</li>\n";
  }
  return section + "</ul>\n";
}

}  // namespace lightwell
