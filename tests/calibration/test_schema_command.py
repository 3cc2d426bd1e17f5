"""`jaxhydro schema`: editors accept by it what the package reads, and mark what it refuses."""

import json
from importlib import resources
from pathlib import Path

import jsonschema
import pytest
from ruamel.yaml import YAML
from typer.testing import CliRunner

from jaxhydro.cli import app as cli

PACKAGE = Path(str(resources.files("jaxhydro")))
FILES = {
    "campaign": sorted(PACKAGE.glob("campaigns/*/campaign.yaml")),
    "platform": [*sorted(PACKAGE.glob("campaigns/*/platform.yaml")), *sorted(PACKAGE.glob("platforms/*.yaml"))],
}


@pytest.fixture(scope="module", params=sorted(FILES))
def schema(request):
    result = CliRunner().invoke(cli.app, ["schema", request.param])
    assert result.exit_code == 0, result.output
    return request.param, jsonschema.Draft202012Validator(json.loads(result.stdout))


def test_what_the_package_brings_is_accepted(schema):
    name, validator = schema
    assert FILES[name]
    for path in FILES[name]:
        validator.validate(YAML(typ="safe").load(path.read_text(encoding="utf-8")))


def test_a_wrong_key_is_marked(schema):
    name, validator = schema
    content = YAML(typ="safe").load(FILES[name][0].read_text(encoding="utf-8")) | {"nmae": "a typo"}
    assert any("nmae" in error.message for error in validator.iter_errors(content))


def test_an_unknown_file_is_refused():
    for word, hint in (("sea", ""), ("campain", ". Did you mean 'campaign'?")):
        result = CliRunner().invoke(cli.app, ["schema", word])
        message = " ".join(result.stderr.split())
        assert result.exit_code == 2 and message.endswith(f"expected campaign or platform, found '{word}'{hint}")
