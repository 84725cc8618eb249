#!/bin/sh
echo '<h1>Validation</h1>'
