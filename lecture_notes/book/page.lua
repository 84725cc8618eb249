-- page.lua: a note as a page of the book. Formulas get numbers and anchors; labels of equations,
-- files, functions and tests become links; pictures get their captions.
--   -M source=PATH   the note, relative to the root of the project
--   -M chapter=N     for the numbers of formulas that have none
--   build/book/places, labels, pages: what is where (sources.sh, build.sh)
local stringify = pandoc.utils.stringify
local source, chapter, formulas, failed
local places, functions, tests, labels, pages, dois = {}, {}, {}, {}, {}, {}

local function complain(message)
  io.stderr:write(source .. ": " .. message .. "\n")
  failed = true
end

local function each_line(path, action)
  local file = assert(io.open(path))
  for line in file:lines() do action(line) end
  file:close()
end

local function read_tables()
  each_line("build/book/places", function(line)
    local kind, name, url = line:match("^(%S+) (%S+) (%S+)$")
    if kind == "file" or kind == "region" then places[name] = url
    elseif kind == "test" then tests[name] = url
    else
      places[name] = url
      local alone = name:match(":(.*)$")
      functions[alone] = functions[alone] and "several" or url
    end
  end)
  each_line("build/book/labels", function(line)
    local label, url = line:match("^(%S+) (%S+)$")
    labels[label] = url
  end)
  each_line("build/book/dois", function(line)
    local key, doi = line:match("^(%S+) (%S+)$")
    dois[doi] = key
  end)
  each_line("build/book/pages", function(line)
    local note, page = line:match("^(%S+) (%S+)")
    pages[note] = page
  end)
end

-- A path without . and .., from the root of the project.
local function resolved(path)
  local parts = {}
  for part in (source:gsub("[^/]*$", "") .. path):gmatch("[^/]+") do
    if part == ".." then table.remove(parts) elseif part ~= "." then table.insert(parts, part) end
  end
  return table.concat(parts, "/")
end

local function target_of(link)
  local doi = link:match("^https://doi%.org/(.*)")
  if doi then
    doi = doi:gsub("%%(%x%x)", function(code) return string.char(tonumber(code, 16)) end)
    return dois[doi] and "bibliography.html#ref-" .. dois[doi]
  end
  if link:match("^#") or link:match("^https?:") then return link end
  local path, anchor = link:match("^([^#]*)(#?.*)$")
  local file = resolved(path)
  local exercise, id = file:match("^lecture_notes/exercises/([^/-]+)%-([^/]*)%.md$")
  if exercise == "projects" then return "exercises_" .. id .. ".html#projects" end
  if exercise then return "exercises_" .. exercise .. ".html#" .. exercise .. "-" .. id end
  if file == "lecture_notes/solutions" then return "exercises_" .. source:match("/0(%w+)_") .. ".html" end
  if pages[file] then return pages[file] .. anchor end
  if places[file] then return places[file] end
  local folder = pages[file .. "/README.md"]
  if folder then return folder end
  return nil
end

local function link_to(content, url, class)
  return pandoc.Link(content, url, "", pandoc.Attr("", {class}))
end

-- [CIC-1], "MPM-5 to MPM-8": every label leads to its equation.
local function with_labels(text)
  local before, here, after = text:match("^([^%(]*)%((%w+)%)(.*)$")
  local url = here and labels[(pages[source] or "") .. ":(" .. here .. ")"]
  if url then
    return {pandoc.Str(before), link_to({pandoc.Str("(" .. here .. ")")}, url, "label"), pandoc.Str(after)}
  end
  local pieces, from = pandoc.List(), 1
  while true do
    local first, last = text:find("%f[%a]%u+%-%d+%f[%D]", from)
    if not first then break end
    local label = text:sub(first, last)
    if labels[label] then
      if first > from then pieces:insert(pandoc.Str(text:sub(from, first - 1))) end
      pieces:insert(link_to({pandoc.Str(label)}, labels[label], "label"))
    elseif label:match("^CIC") or label:match("^FLIP") or label:match("^MPM") or label:match("^IMM") then
      complain("no equation has the label " .. label)
    else
      pieces:insert(pandoc.Str(text:sub(from, last)))
    end
    from = last + 1
  end
  if #pieces == 0 then return nil end
  if from <= #text then pieces:insert(pandoc.Str(text:sub(from))) end
  return pieces
end

local function formula(math)
  if math.mathtype ~= "DisplayMath" then return nil end
  local tag = math.text:match("\\tag{([^}]*)}")
  if not tag then
    formulas = formulas + 1
    tag = chapter .. "." .. formulas
    math.text = math.text .. "\\tag{" .. tag .. "}"
  end
  local inner = pandoc.Span({math}, pandoc.Attr("eq-" .. tag:gsub("[ ,].*", ""), {"equation"}))
  -- "CIC-4, 5" is two labels.
  local method, second = tag:match("^(%u+)%-%d+, (%d+)$")
  if second then inner = pandoc.Span({inner}, pandoc.Attr("eq-" .. method .. "-" .. second)) end
  return inner
end

-- Code that names a file or a function of the project leads to it. in a ledger: `name` (`file`).
local function inlines(list)
  for i, x in ipairs(list) do
    if x.t == "Code" then
      local file = list[i + 3]
      local before, after = list[i + 2], list[i + 4]
      if file and file.t == "Code" and before.t == "Str" and before.text == "(" and
          after and after.t == "Str" and after.text:match("^%)") and file.text:match("/") then
        local url = file.text:match("^tests/") and tests[file.text .. ":" .. x.text:gsub(" ", "_")] or
            places[file.text .. ":" .. x.text]
        if url then list[i] = link_to({x}, url, "code")
        else complain("where is " .. x.text .. " of " .. file.text .. "?") end
      elseif labels["figure:" .. x.text] then list[i] = link_to({x}, labels["figure:" .. x.text], "code")
      elseif places[x.text] then list[i] = link_to({x}, places[x.text], "code")
      elseif functions[x.text] and functions[x.text] ~= "several" and #x.text > 8 then
        list[i] = link_to({x}, functions[x.text], "code")
      end
    elseif x.t == "RawInline" and x.text:match("^<!%-%-") then
      list[i] = pandoc.Str("")
    end
  end
  return list
end

-- The first comment of the script that drew a picture says what it shows.
local function caption_of(name)
  local lines
  for _, method in ipairs({"cic", "flip", "mpm_explicit", "mpm_implicit", "implicit_moment"}) do
    local file = io.open(method .. "/figures/" .. name .. ".gp")
    if file then
      lines = {}
      for line in file:lines() do
        if not line:match("^#") or line:match("^# fits:") then break end
        lines[#lines + 1] = line:gsub("^#%s*", "")
      end
      file:close()
    end
  end
  return lines and #lines > 0 and table.concat(lines, " ") or nil
end

local function escaped(text)
  return (text:gsub("&", "&amp;"):gsub("<", "&lt;"):gsub(">", "&gt;"))
end

local function blocks(list)
  local result = pandoc.List()
  local from
  for _, block in ipairs(list) do
    if block.t == "RawBlock" and block.text:match("^<!%-%-") then
      from = block.text:match("^<!%-%- code: (%S+) %-%->")
    else
      if block.t == "CodeBlock" and from then
        local file = from:match("^[^#]*")
        if not places[file] then complain("no page shows " .. file)
        else
          result:insert(pandoc.Div({pandoc.Plain({link_to({pandoc.Code(file)}, places[from] or places[file], "code")})},
            pandoc.Attr("", {"from"})))
        end
        from = nil
      end
      if block.t == "Para" and block.content[1].t == "Image" then
        for _, image in ipairs(block.content) do
          if image.t == "Image" then
            local name = image.src:match("([^/]*)%.png$")
            local caption = caption_of(name) or stringify(image.caption)
            result:insert(pandoc.RawBlock("html", '<figure id="figure-' .. name .. '"><img src="figures/' ..
              name .. '.png" alt="' .. escaped(stringify(image.caption)) .. '" loading="lazy"><figcaption>' ..
              escaped(caption) .. "</figcaption></figure>"))
          end
        end
      else
        result:insert(block)
      end
    end
  end
  return result
end

-- A row of the ledger can be pointed at, and its label leads to the equation.
local function mark_rows(tab)
  for _, body in ipairs(tab.bodies) do
    for _, row in ipairs(body.body) do
      local label = stringify(row.cells[1].contents)
      if label:match("^%u+%-%d+$") then row.attr = pandoc.Attr("ledger-" .. label); tab.attr = pandoc.Attr("", {"ledger", "wide"}) end
    end
  end
  return tab
end

return {
  {Meta = function(meta)
    source, chapter, formulas = stringify(meta.source), stringify(meta.chapter or ""), 0
    read_tables()
  end},
  {Math = formula, Blocks = blocks, Inlines = inlines, Table = mark_rows},
  {Link = function(link)
    if link.classes:includes("label") or link.classes:includes("code") then return nil end
    local target = target_of(link.target)
    if target then
      link.target = target
      return link
    end
    -- Folders and data are not in the book; what is cited is in the bibliography.
    if link.target:match("^https://doi") or link.target:match("%.md") or link.target:match("%.[ch]pp") then complain("where does " .. link.target .. " lead?") end
    return link.content
  end,
  Header = function(header) return header, false end},
  {traverse = "topdown",
    Header = function(header) return header, false end,
    Link = function(link) return link, false end,
    Str = function(str) return with_labels(str.text), false end},
  {Pandoc = function() if failed then os.exit(1) end end},
}
