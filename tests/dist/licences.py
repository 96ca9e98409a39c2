"""The licences of every crate in the program, as one text: `licences.py < cargo-metadata.json`."""

import json
import pathlib
import sys

NAMES = ("license", "licence", "copying", "notice", "unlicense", "copyright")


def linked(metadata: dict) -> list:
    """The packages that the program is linked from: no build tools, nothing that only tests use."""
    root = metadata["resolve"]["root"]
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    seen, left = set(), [root]
    while left:
        package = left.pop()
        if package in seen:
            continue
        seen.add(package)
        for dependency in nodes[package]["deps"]:
            if any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                left.append(dependency["pkg"])
    seen.discard(root)
    return sorted((package for package in metadata["packages"] if package["id"] in seen), key=lambda p: (p["name"], p["version"]))


def main() -> int:
    metadata = json.load(sys.stdin)
    packages = linked(metadata)
    texts: dict = {}
    missing = []
    for package in packages:
        folder = pathlib.Path(package["manifest_path"]).parent
        files = sorted(path for path in folder.iterdir() if path.is_file() and path.name.lower().startswith(NAMES))
        if package.get("license") is None and not files:
            missing.append(package["name"])
        for path in files:
            texts.setdefault(path.read_text(encoding="utf-8", errors="replace").strip(), []).append(package)
    if missing:
        print(f"these crates state no licence: {', '.join(missing)}", file=sys.stderr)
        return 1
    print(f"pantin is linked from these {len(packages)} crates:\n")
    for package in packages:
        print(f"{package['name']} {package['version']}: {package.get('license') or 'see below'}  {package.get('repository') or ''}".rstrip())
    rule = "=" * 80
    for text, users in texts.items():
        names = ", ".join(f"{user['name']} {user['version']}" for user in users)
        print(f"\n{rule}\n{names}\n{rule}\n\n{text}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
