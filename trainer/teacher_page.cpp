// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <string>

#include "artus/detail/trainer/teacher_server.h"

namespace artus {
namespace {

constexpr const char* kHead = R"(<!doctype html><html><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width,initial-scale=1"><title>artus</title><style>
body{font:16px/1.4 sans-serif;margin:0;padding:.8em;background:#15171a;color:#e6e6e6}
main{display:flex;flex-wrap:wrap;gap:1em}#view{flex:1 1 22em;max-width:44em}#told{flex:1 1 18em}
#frame{position:relative}#picture{width:100%;display:block;background:#000;cursor:crosshair}
#point{position:absolute;width:1.4em;height:1.4em;margin:-.7em;border:2px solid #ffd84d;
border-radius:50%;display:none;pointer-events:none}h1{font-size:1.15em;margin:0 0 .4em}
h2{font-size:1em;margin:.9em 0 .2em;color:#9ab}ul{margin:0;padding-left:1.2em}.done{color:#7d7}
.late{color:#f97}button,input{font:inherit;padding:.35em .7em;background:#2a2f36;color:inherit;
border:1px solid #555;border-radius:4px;margin:.15em .15em .15em 0}button.on{background:#1f5fa8}
#text{width:100%;box-sizing:border-box}#answer{color:#f97;min-height:1.4em}</style></head><body>
)";

constexpr const char* kScript = R"(<script>
const token=new URLSearchParams(location.search).get('token');
const at=path=>path+(token?'?token='+encodeURIComponent(token):'');
const id=name=>document.getElementById(name);let shown=-1,frozen=false,state={};
async function send(command){const answer=await fetch(at('command'),{method:'POST',
headers:{'Content-Type':'application/json'},body:JSON.stringify(command)});
id('answer').textContent=answer.ok?'':await answer.text();}
function list(where,items,text,cls){const ul=id(where);ul.replaceChildren(...items.map(item=>{
const li=document.createElement('li');li.textContent=text(item);li.className=cls?cls(item):'';
return li;}));}
async function look(){try{const answer=await fetch(at('state'));if(!answer.ok)throw 0;
state=await answer.json();id('lost').style.display='none';
id('waits').style.display=state.running?'none':'block';
document.querySelector('main').style.opacity=state.running?1:0.3;
if(state.picture!==shown){shown=state.picture;const image=await fetch(at('picture'));
if(image.ok){const old=id('picture').src;id('picture').src=URL.createObjectURL(await image.blob());
if(old.startsWith('blob:'))setTimeout(()=>URL.revokeObjectURL(old),1000);}}
if(state.running)tell();}catch(e){id('lost').style.display='block';}setTimeout(look,250);}
function tell(){id('title').textContent=state.title+' · '+state.clock;
id('title').className=state.late?'late':'';id('goal').textContent=state.goal;
id('patient').textContent=state.patient;
list('steps',state.steps,s=>s.text,s=>s.done?'done':'');list('marks',state.marks,m=>m);
const n=state.needle,f=v=>v.toFixed(1);
id('needle').textContent=n.inside?n.layer+' · '+f(n.depth_mm)+' mm · '+f(n.to_target_mm)+' → · '+
f(n.beside_plane_mm)+' | '+f(n.plane_angle_deg)+'° · '+f(state.given_ml)+' ml':'-';
for(const b of document.querySelectorAll('[data-aid]'))
b.className=state.aids[b.dataset.aid]?'on':'';}
id('picture').onclick=e=>{const r=id('picture').getBoundingClientRect();
const x=(e.clientX-r.left)/r.width,y=(e.clientY-r.top)/r.height;const p=id('point').style;
p.display='block';p.left=100*x+'%';p.top=100*y+'%';send({do:'point',x:x,y:y});};
id('away').onclick=()=>{id('point').style.display='none';send({do:'point'});};
id('freeze').onclick=()=>{frozen=!frozen;id('freeze').className=frozen?'on':'';
send({do:'freeze',on:frozen});};
for(const b of document.querySelectorAll('[data-aid]'))
b.onclick=()=>send({do:'aid',name:b.dataset.aid,on:!(state.aids||{})[b.dataset.aid]});
id('say').onsubmit=e=>{e.preventDefault();const text=id('text').value.trim();
if(text){send({do:'remark',text:text});id('text').value='';}};look();</script></body></html>
)";

struct PageAid {
  const char* name;
  const char* words;
};
constexpr std::array<PageAid, 5> kPageAids{{{"needle_overlay", msgid("needle's line")},
                                            {"tip_marker", msgid("tip")},
                                            {"target_glow", msgid("target")},
                                            {"labels", msgid("names")},
                                            {"plane_beam", msgid("body cut open")}}};

std::string tag(const char* name, const std::string& attributes, const std::string& text) {
  return std::string("<") + name + " " + attributes + ">" + text + "</" + name + ">";
}

}  // namespace

std::string teacher_page(Language language) {
  const auto say = [language](const char* english) {
    return std::string(translate(language, english));
  };
  std::string aids;
  for (const PageAid& aid : kPageAids)
    aids += tag("button", "data-aid=\"" + std::string(aid.name) + "\"", say(aid.words));
  return kHead +
         tag("p", "id=\"lost\" class=\"late\" style=\"display:none\"",
             say(msgid("The trainer does not answer."))) +
         tag("p", "id=\"waits\"", say(msgid("Nobody is at a task now."))) +
         "<h1 id=\"title\"></h1><main>" +
         "<div id=\"view\"><div id=\"frame\"><img id=\"picture\" alt=\"\"><span "
         "id=\"point\"></span></div>" +
         tag("button", "id=\"freeze\"", say(msgid("Freeze"))) +
         tag("button", "id=\"away\"", say(msgid("Point no longer"))) +
         "<form id=\"say\"><input id=\"text\" maxlength=\"200\" placeholder=\"" +
         say(msgid("A remark: the learner sees it, and the record keeps it")) + "\">" +
         tag("button", "", say(msgid("Say it"))) +
         "</form><p id=\"answer\"></p></div><div id=\"told\">" + "<p id=\"goal\"></p>" +
         tag("h2", "", say(msgid("Patient"))) + "<p id=\"patient\"></p>" +
         tag("h2", "",
             say(msgid("Needle: layer, depth, to the target, beside the plane, injected"))) +
         "<p id=\"needle\"></p>" + tag("h2", "", say(msgid("Steps"))) + "<ul id=\"steps\"></ul>" +
         tag("h2", "", say(msgid("What is judged"))) + "<ul id=\"marks\"></ul>" +
         tag("h2", "", say(msgid("Aids (with one on, the attempt cannot be passed)"))) + aids +
         "</div></main>" + kScript;
}

}  // namespace artus
